"""A floor as a part of somebody's own SimPy model."""
