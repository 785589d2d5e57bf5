"""Figures of results of kind trajectory."""
