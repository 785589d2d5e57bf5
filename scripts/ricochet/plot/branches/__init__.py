"""Figures of results of kind branch."""
