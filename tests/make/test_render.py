"""A picture shows the hand."""

from __future__ import annotations

import numpy as np
import pytest

from fpcad.errors import ToolchainError
from fpcad.make import toolchain
from fpcad.make.render import PicturedTool, View, render_hand


def test_picture_has_skin_bone_and_tool(clay_hand, tmp_path):
    try:
        pv = toolchain.pyvista()
    except (ToolchainError, ImportError) as missing:
        pytest.skip(str(missing))
    tool = PicturedTool(np.eye(4), radius_m=0.006, back_m=-0.08, tip_m=0.08)
    urdf = clay_hand / "hand" / "urdf" / "clay.urdf"
    png = render_hand(
        urdf, {"thumb_mcp_flex": 0.6}, tmp_path / "hand.png", tool, View(size=(320, 240))
    )
    pixels = pv.read(png).point_data["PNGImage"].astype(int)
    reddish = (pixels[:, 0] - pixels[:, 2] > 60).mean()
    assert pixels.shape[0] == 320 * 240
    assert 0.02 < reddish < 0.6
