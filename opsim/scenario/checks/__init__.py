"""What the schema cannot see: names that lead nowhere, work nobody can do, lines without end."""
