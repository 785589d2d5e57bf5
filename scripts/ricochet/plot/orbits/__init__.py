"""Figures of results of kind orbits."""
