"""What may go wrong in a scenario that is right."""
