"""What steps are made of: the structs of a floor, and the small functions that are compiled into each step."""
