"""What hours may do to a floor, by shifts, breaks, lines and crews: warnings of ``opsim check``."""
