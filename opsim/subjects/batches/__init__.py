"""Batches: several jobs on one server at once, such as in an oven."""
