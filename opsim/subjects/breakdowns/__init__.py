"""What stops stations, and who puts it right: breakdowns, planned maintenance, repair teams."""
