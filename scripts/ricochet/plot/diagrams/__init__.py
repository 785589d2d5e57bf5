"""Figures of results of the kinds diagram and basin."""
