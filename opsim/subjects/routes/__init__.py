"""Products and their ways from station to station."""
