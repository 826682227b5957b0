"""A task of several motions, one after the other: their performances, and how bodies pass from one to the next."""
