"""What pm4py and jsonschema find in OCEL 2.0 files, as JSON on the last line. Runs in the readers' own environment.

python read_back.py SCHEMA.json FILE...
"""

import json
import sys
import time
import warnings
from collections import Counter

warnings.filterwarnings("ignore")


def main(schema_file, *files):
    with open(schema_file, encoding="utf-8") as file:
        schema = json.load(file)
    print("\n" + json.dumps([found_in(path, schema) for path in files]))


def found_in(path, schema):
    import pm4py

    begun_s = time.perf_counter()
    if path.endswith(".sqlite"):
        log, complaints = pm4py.read_ocel2_sqlite(path), broken_rules(path)
    else:
        log, complaints = pm4py.read_ocel2_json(path), broken_schema(path, schema)
    read_s = time.perf_counter() - begun_s
    discovered = pm4py.discover_ocdfg(log)
    arcs = {kind: len(couples) for kind, couples in discovered["edges"]["event_couples"].items()}
    return {
        "file": path,
        "events": len(log.events),
        "objects": len(log.objects),
        "relations": len(log.relations),
        "between_objects": len(log.o2o),
        "changes": len(log.object_changes),
        "event_types": Counter(log.events["ocel:activity"]),
        "object_types": Counter(log.objects["ocel:type"]),
        "qualifiers": Counter(log.relations["ocel:qualifier"]),
        "first": log.events["ocel:timestamp"].min().isoformat(),
        "last": log.events["ocel:timestamp"].max().isoformat(),
        "hours": float(log.events["duration_s"].sum()) / 3600 if "duration_s" in log.events else 0.0,
        "complaints": complaints,
        "arcs": arcs,
        "starts": {kind: sorted(names) for kind, names in discovered["start_activities"]["events"].items()},
        "read_s": read_s,
    }


def broken_schema(path, schema):
    import jsonschema

    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    checker = jsonschema.Draft7Validator.FORMAT_CHECKER
    errors = jsonschema.Draft7Validator(schema, format_checker=checker).iter_errors(document)
    return [f"{'/'.join(map(str, error.absolute_path))}: {error.message}"[:200] for error, _ in zip(errors, range(5))]


def broken_rules(path):
    from pm4py.objects.ocel.validation import ocel20_rel_validation

    return list(ocel20_rel_validation.apply(path)[1])


if __name__ == "__main__":
    main(*sys.argv[1:])
