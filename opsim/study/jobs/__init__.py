"""Replications of many points of a study, by any executor: asked for, computed once, kept in a journal."""

from opsim.study.jobs.answers import Answers
from opsim.study.jobs.job import Job, Point, Source

__all__ = ["Answers", "Job", "Point", "Source"]
