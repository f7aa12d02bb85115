import json
import subprocess
import sys
from importlib.metadata import version

import pytest

VERBS = (
    "new",
    "validate",
    "schema",
    "design",
    "solve",
    "sample",
    "evaluate",
    "select",
    "export",
    "run-trajectory",
)


def fpcad(*arguments, cwd=None):
    """The command line as a user runs it: exit code, stdout, stderr."""
    command = [sys.executable, "-m", "fpcad", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=cwd, check=False)
    assert "Traceback" not in done.stderr
    return done.returncode, done.stdout, done.stderr


def test_help_names_every_verb():
    code, out, _ = fpcad("--help")
    assert code == 0
    assert all(f" {verb} " in out for verb in VERBS)


def test_version_is_the_package_s():
    assert fpcad("--version") == (0, f"fpcad {version('fpcad')}\n", "")


def test_schema_is_a_json_schema():
    code, out, _ = fpcad("schema")
    assert code == 0
    assert json.loads(out)["properties"]["poses"]


def test_a_new_spec_is_valid_and_never_overwritten(tmp_path):
    code, out, _ = fpcad("new", "brush", cwd=tmp_path)
    assert (code, out.split(":")[0]) == (0, "designs/brush.yaml")
    assert fpcad("validate", "brush", cwd=tmp_path) == (0, "designs/brush.yaml: valid\n", "")
    code, _, err = fpcad("new", "brush", cwd=tmp_path)
    assert code == 2
    assert "found a file of this name" in err


@pytest.fixture
def broken(tmp_path):
    fpcad("new", "brush", cwd=tmp_path)
    file = tmp_path / "designs" / "brush.yaml"
    text = file.read_text().replace("radius_mm:", "radus_mm:", 1)
    file.write_text(text)
    line = next(i for i, row in enumerate(text.splitlines(), 1) if "radus_mm:" in row)
    return tmp_path, f"designs/brush.yaml:{line}:3 tool.radus_mm"


def test_validate_tells_faults_with_their_place_and_exits_with_2(broken):
    folder, place = broken
    code, out, err = fpcad("validate", "brush", cwd=folder)
    assert (code, out) == (2, "")
    assert place in err
    assert 'did you mean "radius_mm"?' in err


def test_validate_tells_faults_as_json(broken):
    folder, _ = broken
    code, out, _ = fpcad("validate", "brush", "--json", cwd=folder)
    assert code == 2
    assert {"line", "column", "key", "found", "allowed"} <= set(json.loads(out)[0])


def test_stages_refuse_a_faulty_spec_with_the_same_words(broken):
    folder, place = broken
    code, _, err = fpcad("design", "brush", cwd=folder)
    assert code == 2
    assert place in err
    assert not (folder / "build" / "brush").exists()


def test_a_missing_design_is_one_line(tmp_path):
    code, _, err = fpcad("design", "nothing", cwd=tmp_path)
    assert code == 2
    assert err.count("\n") == 1
    assert "designs/nothing.yaml" in err


def test_a_run_without_a_build_says_how_to_make_one(tmp_path):
    fpcad("new", "brush", cwd=tmp_path)
    code, _, err = fpcad("run-trajectory", "brush", "--pose", "tilt", "--port", "sim", cwd=tmp_path)
    assert code == 4
    assert "make them with `fpcad design brush`" in err


def test_a_finished_build_is_up_to_date(built_clay):
    """The stages' keys are functions of spec and code alone."""
    manifest = json.loads((built_clay / "manifest.json").read_text())
    assert {record["status"] for record in manifest["stages"].values()} == {"done"}


@pytest.mark.parametrize("pose", ["carve", "poke", "press"])
def test_every_trajectory_passes_the_checks_before_the_port_is_opened(built_clay, pose):
    spec, build = built_clay / "spec.yaml", built_clay.parent
    code, _, err = fpcad("run-trajectory", spec, "--build", build, "--pose", pose, "--dry-run")
    assert (code, err) == (0, "")


def test_a_trajectory_runs_in_the_simulated_controller(built_clay):
    spec, build = built_clay / "spec.yaml", built_clay.parent
    run = ("run-trajectory", spec, "--build", build, "--pose", "poke", "--json", "--port")
    code, out, _ = fpcad(*run, "sim:10")  # faster, and a busy machine starts it too late
    assert code == 0
    report = json.loads(out)
    assert report["final_state"] == "READY"
    assert report["max_error_all_rad"] < 0.02
    code, out, err = fpcad(*run, "/dev/there-is-none")
    assert (code, out) == (23, "")
    assert err.strip().count("\n") <= 1
