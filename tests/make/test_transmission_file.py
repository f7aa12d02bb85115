"""The transmission file and the bill of materials of a build."""

from __future__ import annotations

import csv

import numpy as np
from ruamel.yaml import YAML

from fpcad.make.transmission_file import transmission_yaml
from fpcad.model.transmission import hand_transmission
from tests.make.hands import CENTRE, CLAY, geometry_of


def test_file_holds_the_models_matrix():
    document = YAML(typ="safe").load(transmission_yaml(CLAY, geometry_of(CENTRE)))
    assert np.array_equal(document["matrix"], hand_transmission(CLAY.motors.transmission, 4))
    assert document["motors"][3:6] == ["index_m1", "index_m2", "index_m3"]
    assert document["joints"][:3] == ["thumb_mcp_flex", "thumb_mcp_abd", "thumb_ip_flex"]
    assert document["offset_rad"] == [0.0] * 12
    assert document["motor_type"] == CLAY.motors.type


def test_bill_counts_what_is_printed_and_bought(clay_hand):
    with (clay_hand / "parts" / "bom.csv").open(newline="") as stream:
        rows = {row["item"]: row for row in csv.DictReader(stream)}
    assert rows["distal_skin"]["count"] == "4" and rows["palm"]["count"] == "1"
    assert rows["motor"]["count"] == "12" and rows["motor"]["size"] == CLAY.motors.type
    for row in rows.values():
        if row["kind"] == "printed":
            assert (clay_hand / "parts" / row["file"]).is_file()
            assert float(row["mass_g"]) > 0
