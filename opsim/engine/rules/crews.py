"""Crews: whose job somebody may take. Members are numbered along the line; -1: nobody has the job."""


def takes_over(member, holder):
    """Bucket brigade: what is in the hands of somebody before him, or in nobody's."""
    return holder < member


def takes_up(member, holder):
    """Rabbit chase: what is in nobody's hands."""
    return holder < 0


def overtakes(station, station_of_next):
    """Whether a job that comes to a station of the line would be ahead of the one that is ahead of it."""
    return station > station_of_next
