"""The order of steps in which a hand goes together; steps for what an assembly lacks are left out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fpcad.make.parts.assembly import Assembly
from fpcad.spec.schema import Spec


def steps(spec: Spec, assembly: Assembly, pretension_n: float) -> Iterator[str]:
    """Numbered lines of Markdown."""
    bought = {item.kind for item in assembly.bought}
    made, on_flange = {part.name for part in assembly.parts}, spec.mount.box
    every: Sequence[tuple[bool, str]] = (
        (True, "Print `fit_coupon` and try the pins in its holes. If the middle hole is too tight or too loose, "
               f"change `print.clearance_mm` (now {spec.print.clearance_mm:g}) by the step of the hole that fits, and export again."),
        (True, "Make one finger first: `fpcad export NAME --finger index` writes its parts alone."),
        ("inserts" in bought, "Melt the heat-set inserts in, flush, at 220 C: two into the flat on the palm's back, one into each "
                              "tension carriage, four into the box. Let them cool."),
        ("bearings" in bought, "Press the bearings into the bones, on their outer rings."),
        (True, "IP joint: put the distal bone's tongue into the proximal bone's clevis and push the pin through."),
        (True, "MCP joint: join the proximal bone to the cross with its two abduction pins, then the cross to the palm "
               "with the flexion pin, from the side."),
        (True, "Move every joint by hand through its range. Nothing may rub; `checks.csv` tells the clearances."),
        ("flange" in made, "Screw the flange's foot on the palm with its two M3 screws. It stands on the flat, not on the sides."),
        ("motor_box" in made, "Slide each carriage with its screw into its room in the box, all the way back; they must slide by hand."),
        ("motor_box" in made, "Push the four M6 nuts into the box's front from inside: motors will cover them."),
        ("motor_box" in made, "Set the motors' ids one by one, and write each on its motor: `motor_places` in `hand/transmission.yaml` "
                              "tells which sits where. Put them in, horns outward, and lead the cables through the lane between the rows."),
        ("spool" in made, "Turn each motor to the middle of its travel and screw a spool on its horn, knots' pockets as drawn."),
        ("box_back" in made, "Bolt the back plate to the robot with its M6 screws, which the closed box covers; then screw the box to it."),
        ("motor_box" in made and on_flange, "Bolt the flange to the box's front with four M6 screws, heads towards the hand."),
        ("motor_box" in made and not on_flange, "Fix the box where it shall stand, and the flange to the robot."),
        ("tubes" in bought, "Cut the tubes as `bom.csv` tells, square and without burrs, and push each into palm and port, by name. "
                            "Those that cross go around each other; none may be pulled tight."),
        (True, "Lead the strands: first the IP loop across the MCP joint, then the two loops of the differential. "
               "Knot them at the anchors as the table says. `hand/transmission.yaml` tells their lengths (`total_mm`, knots not counted)."),
        (True, "Thread each strand through its tube to its spool and knot it in the pocket: flexor and extensor wind oppositely."),
        (True, f"Tighten each loop to {pretension_n:g} N by its tension screw, both strands alike, the finger straight."),
        (True, "Pull the skins over the bones, warm: a hair dryer makes TPE wide. The bend planes face the palm."),
        (True, "Wire the motors, with fuse and switch in the + lead."),
        (True, "Home the hand before the first trajectory, and keep a finger on the switch."),
    )  # fmt: skip
    wanted = (text for needed, text in every if needed)
    yield from (f"{number}. {text}" for number, text in enumerate(wanted, start=1))
