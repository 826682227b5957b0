"""The tests mirror the packages; shared helpers are naive.py (twins), made.py (made sequences), recordings.py (public data)."""
