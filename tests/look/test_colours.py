"""Colours of the page: legible on their grounds, and apart for every kind of colour vision."""

from __future__ import annotations

import itertools
import re
from importlib.resources import files

import numpy as np
import pytest
from colorspacious import cspace_convert, deltaE

STYLE = (files("fpcad.look") / "page" / "report.css").read_text(encoding="utf-8")
PALETTES = dict(
    zip(
        ("light", "dark"),
        (
            dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", block))
            for block in re.findall(r":root[^{]*\{([^}]*)\}", STYLE)
        ),
        strict=True,
    )
)
VISIONS = (None, "deuteranomaly", "protanomaly", "tritanomaly")
CURVES = [f"curve-{i}" for i in range(5)]
TOGETHER = (
    ("front", "muted", "chosen", "selected"),
    ("normal", "force", "load"),
    ("muted", *CURVES),
)
"""Colours that stand in one figure and mean different things."""
FAR_APART = 15.0
"""Distance in CAM02-UCS; one that is just seen side by side is about 1."""
TEXT, GRAPHICS = 4.5, 3.0
"""Contrast that WCAG 2 asks of text and of what figures are made of."""


def rgb(colour: str) -> np.ndarray:
    return np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])


def seen(colour: str, vision: str | None) -> np.ndarray:
    """A colour [sRGB] as somebody without one kind of cones sees it (Machado et al., 2009)."""
    if vision is None:
        return rgb(colour)
    space = {"name": "sRGB1+CVD", "cvd_type": vision, "severity": 100}
    return np.clip(cspace_convert(rgb(colour), space, "sRGB1"), 0, 1)


def contrast(first: str, second: str) -> float:
    """Contrast ratio of WCAG 2."""
    linear = [
        np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
        for c in map(rgb, (first, second))
    ]
    dark, bright = sorted(float(c @ [0.2126, 0.7152, 0.0722]) for c in linear)
    return (bright + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("scheme", PALETTES)
@pytest.mark.parametrize("ground", ["paper", "panel", "plot", "warn"])
def test_text_is_legible(scheme, ground):
    palette = PALETTES[scheme]
    inks = ["ink"] if ground == "warn" else ["ink", "quiet", "accent"]
    for ink in inks:
        assert contrast(palette[ink], palette[ground]) >= TEXT, ink


@pytest.mark.parametrize("scheme", PALETTES)
def test_points_curves_and_arrows_stand_out(scheme):
    palette = PALETTES[scheme]
    for name in {name for group in TOGETHER for name in group}:
        assert contrast(palette[name], palette["plot"]) >= GRAPHICS, name


@pytest.mark.parametrize("scheme", PALETTES)
@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize("names", TOGETHER)
def test_colours_of_one_figure_are_told_apart(scheme, vision, names):
    colours = {name: seen(PALETTES[scheme][name], vision) for name in names}
    for a, b in itertools.combinations(names, 2):
        assert deltaE(colours[a], colours[b], input_space="sRGB1") >= FAR_APART, (a, b)
