"""Conveyors: belts and roller tracks that take jobs from one place to another."""
