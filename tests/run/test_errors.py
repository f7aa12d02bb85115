import pickle

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
