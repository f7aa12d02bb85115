"""Ranking of hands and the choice of one, from tables that are given."""

from fpcad.select.choose import RULES, Choice, choose, finalists
from fpcad.select.front import pareto_front
from fpcad.select.ranking import rank_table
from fpcad.select.scores import score, score_table

__all__ = [
    "RULES",
    "Choice",
    "choose",
    "finalists",
    "pareto_front",
    "rank_table",
    "score",
    "score_table",
]
