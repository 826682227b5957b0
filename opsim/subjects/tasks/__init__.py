"""Tasks: how long a piece of work takes, and by which movement; heights of hands."""
