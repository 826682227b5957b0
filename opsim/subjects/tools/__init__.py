"""Tools and fixtures that stations and tasks share."""
