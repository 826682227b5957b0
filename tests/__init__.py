"""The tests mirror the packages; naive.py has the kernels' twins, made.py sequences, recordings.py the public data."""
