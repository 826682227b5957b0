"""The job files in examples/cluster say what opsim understands."""

import re
import shlex
from pathlib import Path

import pytest
import yaml

from opsim.cli import main

CLUSTER = Path(__file__).parents[1] / "examples" / "cluster"
FILES = sorted(CLUSTER.iterdir())
NUMBERS = {"$SLURM_ARRAY_TASK_ID": "3", "$((JOB_COMPLETION_INDEX + 1))": "3", "$SLURM_CPUS_PER_TASK": "2"}


def commands():
    """Every call of opsim in the files, in words, with variables of the cluster filled in."""
    for path in FILES:
        text = path.read_text()
        for name, value in NUMBERS.items():
            text = text.replace(name, value)
        for found in re.findall(r"(?:^|srun |- |    )opsim ((?:sweep|select|merge|labour|layout) [^\n]+)", text, re.M):
            yield path.name, shlex.split(found.partition("  #")[0])


def test_every_file_calls_opsim():
    assert {name for name, _ in commands()} == {path.name for path in FILES}


@pytest.mark.parametrize(
    ("name", "words"), list(commands()), ids=lambda of: " ".join(of) if isinstance(of, list) else of
)
def test_commands_are_understood(name, words):
    context = main.make_context("opsim", list(words), resilient_parsing=True)
    verb = main.get_command(context, words[0])
    parsed = verb.make_context(words[0], list(words[1:]))
    if shard := parsed.params.get("shard"):
        from opsim.study.jobs.job import Shard

        assert Shard.read(shard).number <= Shard.read(shard).of


def test_the_kubernetes_job_is_indexed_and_its_shards_are_as_many_as_its_pods():
    job = yaml.safe_load((CLUSTER / "kubernetes_job.yaml").read_text())
    assert (job["apiVersion"], job["kind"], job["spec"]["completionMode"]) == ("batch/v1", "Job", "Indexed")
    (container,) = job["spec"]["template"]["spec"]["containers"]
    assert f"+ 1))/{job['spec']['completions']}" in container["args"][0]
    assert job["spec"]["template"]["spec"]["restartPolicy"] == "OnFailure"


def test_the_slurm_array_has_as_many_tasks_as_shards():
    text = (CLUSTER / "slurm_array.sh").read_text()
    assert "--array=1-8" in text and "$SLURM_ARRAY_TASK_ID/8" in text and text.startswith("#!/bin/bash\n")
