"""Parts of the floor that several rules share."""
