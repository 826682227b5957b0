"""``python -m opsim``: the command line."""

from opsim.cli import main

if __name__ == "__main__":
    main()
