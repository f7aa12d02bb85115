import pickle
from pathlib import Path

from fpcad.errors import FpcadError
from fpcad.run import errors

CLASSES = [
    c for c in vars(errors).values() if isinstance(c, type) and issubclass(c, errors.RunError)
]


def test_each_cause_has_its_own_exit_code_from_20_on():
    codes = [cls.exit_code for cls in CLASSES]
    assert len(set(codes)) == len(codes) and min(codes) == 20
    assert set(codes).isdisjoint(
        {cls.exit_code for cls in FpcadError.__subclasses__() if cls not in CLASSES}
    )


def test_errors_survive_pickling():
    for cls in CLASSES:
        copy = pickle.loads(pickle.dumps(cls("what", "where")))
        assert type(copy) is cls and copy.args == ("what", "where")


def test_every_exit_code_is_documented():
    text = (Path(__file__).parents[2] / "docs" / "exit-codes.md").read_text()
    rows = {
        line.split("|")[1].strip(): line.split("|")[2].strip()
        for line in text.splitlines()
        if line.startswith("| ")
    }
    assert all(rows.get(str(cls.exit_code)) == cls.__name__ for cls in CLASSES)


def test_a_failure_is_one_line_that_ends_with_the_hand():
    for cls in CLASSES:
        said = str(cls("something happened; do this"))
        assert "\n" not in said and said.startswith("something happened; do this")
        assert said.endswith(cls.hand)
    assert str(errors.LinkLost("gone?").leaving("It holds.")) == "gone? It holds."
