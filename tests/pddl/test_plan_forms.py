"""Plans as planners, planning services and language models print them: one plan in all forms."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.plan_file import parse_plan
from tmd.pddl.reading.reader import parse_domain, parse_problem

DOMAIN = """(define (domain ferry) (:requirements :strips :typing) (:types car quay)
  (:predicates (at ?c - car ?q - quay) (ferry ?q - quay) (on ?c - car) (idle))
  (:action sail :parameters (?a ?b - quay) :precondition (ferry ?a) :effect (and (ferry ?b) (not (ferry ?a))))
  (:action board :parameters (?c - car ?q - quay)
    :precondition (and (at ?c ?q) (ferry ?q)) :effect (and (on ?c) (not (at ?c ?q))))
  (:action rest :parameters () :precondition (and) :effect (idle)))"""
PROBLEM = """(define (problem f1) (:domain ferry) (:objects red blue - car north south - quay)
  (:init (at red north) (at blue south) (ferry north)) (:goal (and (on red) (on blue))))"""
PLAN = (
    Instruction("board", ("red", "north")),
    Instruction("sail", ("north", "south")),
    Instruction("rest"),
    Instruction("board", ("blue", "south")),
)


@pytest.fixture(scope="module")
def ferry() -> Problem:
    return parse_problem(PROBLEM, parse_domain(DOMAIN))


LAMA = """INFO     Running search.
[t=0.0004s, 9988 KB] New best heuristic value for ff: 3
[t=0.0005s, 9988 KB] Solution found!
[t=0.0005s, 9988 KB] Actual search time: 0.0001s
sail north south (1)
sail south north (1)
rest  (1)
[t=0.0005s, 9988 KB] Plan length: 3 step(s).
[t=0.0005s, 9988 KB] Plan cost: 3
[t=0.0006s, 9988 KB] Solution found!
board red north (1)
sail north south (1)
rest  (1)
board blue south (1)
[t=0.0007s, 9988 KB] Plan length: 4 step(s).
[t=0.0007s, 9988 KB] Expanded 5 state(s).
Completely explored state space -- no solution!
Solution found.
"""
FORMS = {
    "plan file": "(board red north)\n(sail north south)\n(rest)\n(board blue south)\n; cost = 4 (unit cost)\n",
    "FF": """ff: found legal plan as follows

step    0: BOARD RED NORTH
        1: SAIL NORTH SOUTH
        2: REST
        3: BOARD BLUE SOUTH
        4: REACH-GOAL


time spent:    0.00 seconds instantiating 8 easy, 0 hard action templates
               0.00 seconds searching, evaluating 4 states, to a max depth of 2
""",
    "ENHSP": """Problem Solved
Found Plan:
0.0: (board red north)
1.0: (sail north south)
2.0: (rest)
3.0: (board blue south)

Plan-Length:4
Metric (Search):4.0
""",
    "OPTIC": """Number of literals: 7
b (3.000 | 0.001)
; Plan found with metric 5.000
; States evaluated so far: 4
0.000: (sail north south)  [1.000]
1.001: (rest)  [1.000]

* All goal deadlines now no later than 4.000
b (2.000 | 2.001)b (1.000 | 3.002)
;;;; Solution Found
; Cost: 4.003
0.000: (board red north)  [1.000]
1.001: (sail north south)  [1.000]
2.002: (rest)  [1.000]
3.003: (board blue south)  [1.000]

Resorting to best-first search
Running WA* with W = 5.000, not restarting with goal states
""",
    "LPG": """Plan computed:
   Time: (ACTION) [action Duration; action Cost]
 0.0003:   (BOARD RED NORTH) [D:1.0000; C:1.0000])
 1.0005:   (SAIL NORTH SOUTH) [D:1.0000; C:1.0000])
 2.0008:   (REST) [D:1.0000; C:1.0000])
 3.0010:   (BOARD BLUE SOUTH) [D:1.0000; C:1.0000])
""",
    "LAMA": LAMA,
    "pyperplan": """2026-03-04 09:00:00,120 INFO     Goal reached. Start extraction of solution.
2026-03-04 09:00:00,120 INFO     Plan length: 4
(board red north)
(sail north south)
(rest)
(board blue south)
""",
    "BFWS": "0. ( BOARD RED NORTH )\n1. ( SAIL NORTH SOUTH )\n2. ( REST )\n3. ( BOARD BLUE SOUTH )\n",
    "Madagascar": """Plan found: 3 steps.
STEP 0: board(red,north)
STEP 1: sail(north,south) rest()
STEP 2: board(blue,south)
4 actions in the plan.
""",
    "PDDL4J": """found plan as follows:

00: (   board red north) [0]
01: (sail north south) [0]
02: (            rest) [0]
03: (board blue south) [0]

time spent:       0.01 seconds parsing
""",
    "PANDA": """==>
1 board red north
2 sail north south
5 rest
7 board blue south
root 9
9 cross red blue -> m-cross 1 2 5 7
<==
""",
    "unified-planning": """SequentialPlan:
    board(red, north)
    sail(north, south)
    rest
    board(blue, south)
""",
    "times of unified-planning": """TimeTriggeredPlan:
    0.0: board(red, north) [1.0]
    1.01: sail(north, south) [1.0]
    2.02: rest() [1.0]
    3.03: board(blue, south) [1.0]
""",
    "list": """Here is the plan:

1. **(board red north)** - drive on
2. (sail north south)
3. `rest()`: wait for the tide
4. board blue south
""",
    "fence": "Yes\n```pddl\n(board red north)\n(sail north south)\n(rest)\n(board blue south)\n```\nso (on red)\n",
    "prose": "First do (board red north), then (sail north south) and (rest), and (board blue south) (see above).",
    "table": """| Step | Action |
|---|---|
| 1 | board red north |
| 2 | sail north south |
| 3 | (rest) |
| 4 | board(blue, south) |
""",
    "one line": "(board red north)(sail north south)(rest)(board blue south)",
    "Lisp list": "((board red north)\n (sail north south)\n (rest) (board blue south))",
    "tuples": "[('board', 'red', 'north'), ('sail', 'north', 'south'), ('rest',), ('board', 'blue', 'south')]",
    "graphplan": "Time step 1: board red north\nTime step 2: sail north south\n"
    "Time step 3: rest\nTime step 4: board blue south\n",
    "dashes": "Step 1 - board red north\nStep 2 - sail north south\nStep 3 - rest\nStep 4 - board blue south\n",
    "letters": "a) board red north\nb) sail north south\nc) rest\nd) board blue south\n",
    "numbers in parentheses": "(1) board red north\n(2) sail north south\n(3) rest\n(4) board blue south\n",
    "numbers in brackets": "[0] board red north\n[1] sail north south\n[2] rest\n[3] board blue south\n",
    "columns": "step,action,first,second\n1,board,red,north\n2,sail,north,south\n3,rest,,\n4,board,blue,south\n",
    "square brackets": "[board red north]\n[sail north south]\n[rest]\n[board blue south]\n",
    "named": "board(c=red, q=north)\nsail(b=south, a=north)\nrest()\nboard(q=south, c=blue)\n",
    "named with colons": "(board c: red q: north)\n(sail a: north b: south)\n(rest)\n(board c: blue q: south)\n",
    "joined": "board_red_north\nsail_north_south\nrest\nboard_blue_south\n",
    "joined by hyphens": "(board-red-north)\n(sail-north-south)\n(rest)\n(board-blue-south)\n",
    "thoughts": "<think>Not (board blue south) first.\n(rest)?</think>\n"
    "(board red north)\n(sail north south)\n(rest)\n(board blue south)",
    "YAML": "plan:\n" + "".join(f"- action: {s.name}\n  args: [{', '.join(s.args)}]\n" for s in PLAN),
    "YAML in a fence": "So:\n```yaml\n"
    + "".join(f"- {s.name}: [{', '.join(s.args)}]\n" for s in PLAN)
    + "```\nDone.\n",
    "Python": "plan = [\n" + "".join(f"  {{'name': '{s.name}', 'args': {list(s.args)}}},\n" for s in PLAN) + "]\n",
    "JSON lines": "".join(json.dumps({"action": s.name, "args": s.args}) + "\n" for s in PLAN),
    "JSON in a fence": f"Here:\n```json\n{json.dumps({'plan': [' '.join((s.name, *s.args)) for s in PLAN]})}\n```\n",
    "JSON in prose": "The plan is "
    + json.dumps({"steps": [{"action": s.name, "arguments": s.args} for s in PLAN]}, indent=1)
    + " as asked.\n",
    "planning.domains": json.dumps(
        {
            "status": "ok",
            "result": {
                "output": "Plan found.\n",
                "plan": [{"name": step.pddl(), "action": f"(:action {step.name}\n :parameters (x))"} for step in PLAN],
            },
        },
        indent=1,
    ),
    "planning service": json.dumps(
        {"result": {"output": {"sas_plan": "\n".join(s.pddl() for s in PLAN)}, "log": LAMA}}
    ),
    "JSON texts": json.dumps({"plan": [*(step.pddl().upper() for step in PLAN), "(reach-goal)"], "error": "none"}),
    "JSON calls": json.dumps([str(step) for step in PLAN]),
    "Action of Python": "[" + ", ".join(f"Action({', '.join((s.name, *s.args))})" for s in PLAN) + "]\n",
    "Action with a list": "".join(f"Action({s.name!r}, {list(s.args)})\n" for s in PLAN),
    "Action with names": "plan = [\n" + "".join(f"  Action(name={s.name!r}, args={s.args}),\n" for s in PLAN) + "]\n",
    "Action with named objects": "Action(name='board', parameters={'q': 'north', 'c': 'red'})\n"
    "Action('sail', {'b': 'south', 'a': 'north'})\nAction('rest')\nAction('board', {'c': 'blue', 'q': 'south'})\n",
    "instances of unified-planning": "SequentialPlan([\n"
    + "".join(f"  up.plans.ActionInstance({s.name}, ({', '.join(s.args)})),\n" for s in PLAN)
    + "])\n",
    "pairs": f"{[(s.name, s.args) for s in PLAN]}\n",
    "semicolons between": "; ".join(s.pddl() for s in PLAN) + "\n",
    "words in a row": "First " + "; then ".join(" ".join((s.name, *s.args)) for s in PLAN) + ".\n",
    "arrows": " -> ".join(" ".join((s.name, *s.args)) for s in PLAN) + "\n",
    "operators of SHOP": "((" + " ".join(f"(!{s.name.upper()} {' '.join(s.args).upper()}) 1.0" for s in PLAN) + "))\n",
    "states between": "State 0: (at red north)\n"
    + "".join(f"Action {n}: {s}\nState {n}: (on red)\n" for n, s in enumerate(PLAN)),
    "table with effects": "| step | effect |\n|---|---|\n" + "".join(f"| `{s}` | on(red) |\n" for s in PLAN),
    "PANDA's brackets": "0 board[red,north]\n1 sail[north,south]\n2 rest[]\n3 board[blue,south]\n",
    "quotes of a printer": "{\u201cplan\u201d: ["
    + ", ".join(f"\u201c{' '.join((s.name, *s.args))}\u201d" for s in PLAN)
    + "]}\n",
    "JSON numbers": json.dumps({"plan": {f"step {n}": " ".join((s.name, *s.args)) for n, s in enumerate(PLAN)}}),
    "JSON arguments in a text": json.dumps([{"action": s.name, "args": " ".join(s.args)} for s in PLAN]),
    "JSON actions in steps": json.dumps(
        {"steps": [{"id": n, "action": {"name": s.name, "args": s.args}} for n, s in enumerate(PLAN, start=1)]}
    ),
    "JSON equations": json.dumps(
        [
            {"name": "board", "params": ["?q=north", "?c=red"]},
            {"name": "sail", "params": ["?a=north", "?b=south"]},
            {"name": "rest", "params": []},
            {"name": "board", "params": ["?c=blue", "?q=south"]},
        ]
    ),
    "YAML named objects": "- board: {q: north, c: red}\n- sail: {a: north, b: south}\n- rest: {}\n"
    "- board: {c: blue, q: south}\n",
    "JSON named objects": json.dumps(
        [
            {"action": "board", "parameters": {"q": "north", "?c": "red"}},
            {"action": "sail", "b": "south", "a": "north"},
            {"action": "rest", "parameters": {}},
            {"action": "board", "parameters": {"c": "blue", "q": "south"}},
        ]
    ),
    "JSON steps": json.dumps([{"start": 0.0, "parameters": list(step.args), "action": step.name} for step in PLAN]),
    "XML elements": "<?xml version='1.0'?>\n<plan>\n"
    + "".join(f"<action name='{s.name}'>{''.join(f'<param>{arg}</param>' for arg in s.args)}</action>\n" for s in PLAN)
    + "</plan>\n",
    "XML attributes": "<plan>\n"
    + "".join(f'<step n="{n}"><action name="{s.name}" args="{" ".join(s.args)}"/></step>\n' for n, s in enumerate(PLAN))
    + "</plan>\n",
    "ASP": "Answer: 1\noccurs(rest,3) occurs(sail(north,south),2) "
    "occurs(board(blue,south),4) occurs(board(red,north),1)\n"
    "SATISFIABLE\n",
    "ASP facts": "do(9,board(red,north)).\ndo(10,sail(north,south)).\ndo(11,rest).\ndo(12,board(blue,south)).\n",
    "plasp": 'occurs(action(("board",constant("red"),constant("north"))),1) '
    'occurs(action(("sail",constant("north"),constant("south"))),2) occurs(action(("rest")),3)\n'
    'occurs(action(("board",constant("blue"),constant("south"))),4)\n',
    "JSON words": json.dumps({"actions": [[step.name, *step.args] for step in PLAN]}),
}


@pytest.mark.parametrize("text", FORMS.values(), ids=FORMS)
def test_forms_of_plans(text: str, ferry: Problem) -> None:
    plan = parse_plan(text, "log", ferry)
    assert plan.instructions == PLAN
    lines = text.splitlines()
    for step, place in zip(plan.instructions, plan.locations, strict=True):
        assert place.line is not None and step.name in lines[place.line - 1].lower()


@pytest.mark.parametrize(
    ("text", "which"),
    [
        (LAMA, "log:11:1: 2 plans are in log; the last one is taken"),
        (LAMA[: LAMA.index("board blue")], "log:5:1: 2 plans are in log; the last whole one is taken"),
        ("(rest)\n; cost = 1 (unit cost)\n(rest)\n(rest)\n", "log:3:1: 2 plans are in log; the last one is taken"),
        ('{"plans": [["(rest)"], ["(rest)", "(rest)"]]}', "log:1:14: 2 plans are in log; the first one is taken"),
    ],
)
def test_of_several_plans_one_is_taken(text: str, which: str, ferry: Problem) -> None:
    assert parse_plan(text, "log", ferry).warnings[0] == which


def test_what_else_a_record_says_is_no_step(ferry: Problem) -> None:
    steps = [{"action": step.name, "args": list(step.args), "clause": 0} for step in PLAN]
    record = {"clauses": [{"verb": "board", "objects": ["red"]}], "plans": [{"steps": steps, "goal": "(on red)"}]}
    plan = parse_plan(json.dumps(record), "record.json", ferry)
    assert plan.instructions == PLAN
    assert not plan.warnings


@pytest.mark.parametrize(
    ("text", "line", "step"),
    [
        ("(rest)\n(sale north south)\n", 2, Instruction("sale", ("north", "south"))),
        ("step 0: REST\n 1: SAIL NORTH WEST\n 2: REST\n", 2, Instruction("sail", ("north", "west"))),
        ("0: SALE NORTH SOUTH\n 1: SAIL SOUTH NORTH\n", 1, Instruction("sale", ("north", "south"))),
        ("sail north south (1)\nsail south\n", 2, Instruction("sail", ("south",))),
        ("Then (sale north south) is done.\nThen (rest).\n", 1, Instruction("sale", ("north", "south"))),
        ('["(rest)",\n "sale(north, south)"]', 2, Instruction("sale", ("north", "south"))),
    ],
)
def test_a_step_of_unknown_names_is_kept_with_its_line(text: str, line: int, step: Instruction, ferry: Problem) -> None:
    plan = parse_plan(text, "log", ferry)
    assert step in plan.instructions
    assert plan.locations[plan.instructions.index(step)].line == line


@pytest.mark.parametrize(
    ("text", "message", "line"),
    [
        ("ff: goal can be simplified to FALSE. No plan will solve it\n", "there is no plan here", 1),
        ("Parsing\nSearch stopped without finding a solution.\n", "there is no plan here", 2),
        ('{"status": "error",\n "result": {"output": "No plan found"}}', "there is no plan here", 2),
        ("I would rather not board the ferry.\n", "there is no plan in this text", 1),
        ('{"plan": []}', "there is no plan in this text", 1),
        ("step 0: REST\nboard the red car (sail north\n", "this step is not closed", 2),
        (LAMA[LAMA.index("board red") : LAMA.index("board blue")] + "Plan length: 4\n", "the plan is cut off", 3),
    ],
)
def test_texts_without_a_whole_plan(text: str, message: str, line: int, ferry: Problem) -> None:
    with pytest.raises(TmdError) as caught:
        parse_plan(text, "log", ferry)
    assert message in caught.value.message
    assert caught.value.location is not None and caught.value.location.line == line


@pytest.mark.parametrize(
    "text",
    ["", "; cost = 0 (unit cost)\n", "Solution found!\nPlan length: 0 step(s).\n", "ff: The empty plan solves it\n"],
)
def test_plans_without_steps(text: str, ferry: Problem) -> None:
    assert parse_plan(text, "log", ferry).instructions == ()


@pytest.mark.parametrize("word", ["sail_north_west", "sail_north", "board_red_north_south", "board_red_"])
def test_joined_names_are_steps_only_where_all_are_known(word: str, ferry: Problem) -> None:
    assert Instruction("board", ("red", "north")) not in _steps(f"(rest)\n({word})\n", ferry)
    assert Instruction(word) in _steps(f"(rest)\n({word})\n", ferry)


def test_joined_names_of_two_readings_stay_together() -> None:
    domain = parse_domain(
        DOMAIN.replace("(:action rest", "(:action sail_north").replace(":parameters () ", ":parameters (?q - quay) ")
    )
    problem = parse_problem(PROBLEM, domain)
    assert _steps("(sail_north_south)\n", problem) == (Instruction("sail_north_south"),)


def _steps(text: str, problem: Problem) -> tuple[Instruction, ...]:
    return parse_plan(text, "log", problem).instructions


@given(
    st.lists(st.sampled_from(PLAN), min_size=1), st.sampled_from(["{}\n", "{} ", "1. {}\n", "- `{}`\n", "{}, then "])
)
def test_steps_are_found_in_any_dress(ferry: Problem, plan: list[Instruction], dress: str) -> None:
    for written in (Instruction.pddl, str):
        text = "".join(dress.format(written(step)) for step in plan)
        assert parse_plan(text, "log", ferry).instructions == tuple(plan)


@given(st.text(alphabet='()[]{}":;,. \nrest0<->=_&*') | st.lists(st.sampled_from(LAMA.split(" "))).map(" ".join))
def test_any_text_is_a_plan_or_one_clear_line(ferry: Problem, text: str) -> None:
    try:
        parse_plan(text, "log", ferry)
    except TmdError as error:
        assert "\n" not in error.message
