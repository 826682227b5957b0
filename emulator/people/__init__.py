"""Who performs: variance between and within workers, and people who were never recorded."""
