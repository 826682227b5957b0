"""What ``opsim motion people`` found: as lines and tables for people, CSV for programs, a picture and a page."""
