"""Figures of results of kind grazing."""
