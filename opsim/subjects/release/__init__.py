"""What comes in: sources, schedules of orders, base stock."""
