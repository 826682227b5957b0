"""A study of three points that takes no time: for tests of how studies are run, split and gone on with."""

import click

from opsim.cli.study_options import Kind, Told, study_options
from opsim.report.page import StudyPage, Table
from opsim.report.page import StudySection as Section
from opsim.study.jobs import Job, Point

BUFFERS = (1, 2, 4)


def points(variant="base"):
    return [Point(f"buffer {n}", {"stations.saw.buffer": n}, variant) for n in BUFFERS]


def study(asked, answers):
    made = points(asked.variant)
    answers.check(made)
    jobs = [Job(point, n) for point in made for n in range(asked.replications)]
    values = answers.values(jobs, [("throughput_per_h", "", "", "1/h")]).reshape(len(made), -1)
    table = Table(("point", "1/h"), [(point.name, f"{row.mean():.6f}") for point, row in zip(made, values)])
    page = StudyPage(asked.loaded.scenario.name, "sweep", ["Done."], [Section("Points", table=table, on_screen=True)])
    return Told({"values": values.tolist()}, page)


def kept(asked):
    return ("throughput_per_h", "station_states")


KIND = Kind("sweep", study, kept)


@click.command("sweep")
@click.argument("file")
@study_options()
def command(file, common):
    from opsim.cli.study import run_study

    run_study(KIND, file, common, {})
