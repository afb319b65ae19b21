"""PDDL as language models and students write it: one message for a slip, and a repair where it is clear."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.check.diagnostic import Diagnostic, Severity
from tmd.check.report import check_paths

DOMAIN = """\
(define (domain garden)
  (:requirements :strips :typing)
  (:types can bed)
  (:predicates (at ?c - can ?b - bed) (path ?x ?y - bed) (full ?c - can) (moist ?b - bed))
  (:action carry
    :parameters (?c - can ?x ?y - bed)
    :precondition (and (at ?c ?x) (path ?x ?y))
    :effect (and (at ?c ?y) (not (at ?c ?x))))
  (:action pour
    :parameters (?c - can ?b - bed)
    :precondition (and (at ?c ?b) (full ?c))
    :effect (moist ?b)))
"""
PROBLEM = """\
(define (problem june)
  (:domain garden)
  (:objects tin jug - can roses herbs - bed)
  (:init (at tin roses) (at jug herbs) (full tin) (path roses herbs))
  (:goal (and (moist roses) (moist herbs))))
"""
PRECONDITION = "(and (at ?c ?x) (path ?x ?y))"
NO_TYPES = ("  (:types can bed)\n", "")

# Which file, what is replaced by what, the kind, and what the hint says. Each is repaired by --fix.
REPAIRED = {
    "one condition in :init": (
        "problem",
        "(at tin roses) (at jug herbs)",
        "(and (at tin roses) (at jug herbs))",
        "nested-init",
        "alone",
    ),
    "a colon before domain": ("domain", "(domain garden)", "(:domain garden)", "syntax", "without a colon"),
    "fences": ("domain", "(define (domain", "```lisp\n(define (domain", "foreign-text", "remove"),
    "fences around": ("problem", PROBLEM, f"```\n{PROBLEM}```\n", "foreign-text", "remove"),
    "a sentence before": ("domain", "(define (domain", "Sure (as asked):\n(define (domain", "foreign-text", "remove"),
    "a sentence behind": ("problem", "herbs))))\n", "herbs))))\nWater (all) beds.\n", "foreign-text", "remove"),
    "a heading": ("domain", "(define (domain", "## The domain\n(define (domain", "foreign-text", '";"'),
    "Lisp": ("problem", "(define (problem", "(in-package :pddl)\n(define (problem", "foreign-text", "remove"),
    "Lisp with a name in quotes": (
        "domain",
        "(define (domain",
        '(in-package "GARDENS")\n(define (domain',
        "foreign-text",
        "remove",
    ),
    "a sentence with quotes": (
        "domain",
        "(define (domain",
        'The "garden" domain costs $nothing:\n(define (domain',
        "foreign-text",
        "remove",
    ),
    "a block of comments": ("domain", "  (:types", "#| two\ntypes |# (:types", "foreign-text", '";"'),
    "comments of C": ("domain", "  (:types", "  // two types\n  (:types", "foreign-text", '";"'),
    "escaped": ("domain", DOMAIN, DOMAIN.replace("\n", "\\n"), "foreign-text", "ends of lines"),
    "two problems": (
        "problem",
        "herbs))))\n",
        "herbs))))\n\n(define (problem july) (:domain garden) (:goal (and)))\n",
        "two-definitions",
        "july.pddl",
    ),
    "commas": ("problem", "tin jug - can roses herbs", "tin, jug - can roses,herbs", "other-notation", "blanks"),
    "commas of parameters": ("domain", "?c - can ?x ?y - bed", "?c - can, ?x, ?y - bed", "other-notation", "blanks"),
    "calls": ("problem", "(at tin roses)", "at(tin, roses)", "other-notation", "(at tin roses)"),
    "calls within": ("domain", ":effect (moist ?b)", ":effect (moist(?b))", "other-notation", "(moist ?b)"),
    "calls as effects": ("domain", ":effect (moist ?b)", ":effect moist(?b)", "other-notation", "(moist ?b)"),
    "calls negated": ("domain", "(not (at ?c ?x))", "not(at(?c, ?x))", "other-notation", "(at ?c ?x)"),
    "calls declared": ("domain", "(full ?c - can)", "full(?c - can)", "other-notation", "(full ?c - can)"),
    "unequal": ("domain", "(path ?x ?y))\n", "(path ?x ?y) (!= ?x ?y))\n", "other-notation", "(not (= ?x ?y))"),
    "unequal between": ("domain", "(path ?x ?y))\n", "(path ?x ?y) (?x != ?y))\n", "other-notation", "(not (= ?x ?y))"),
    "and between": ("domain", PRECONDITION, "((at ?c ?x) and (path ?x ?y))", "other-notation", "(and"),
    "ampersands": ("domain", "(and (at ?c ?b)", "(&& (at ?c ?b)", "other-notation", "and"),
    "exclamation mark": ("domain", "(not (at ?c ?x))", "(! (at ?c ?x))", "other-notation", "not"),
    "nil": ("domain", f":precondition {PRECONDITION}", ":precondition nil", "other-notation", "(and)"),
    "colons": ("domain", "(?c - can ?b - bed)\n", "(?c: can ?b:bed)\n", "other-notation", "?c - "),
    "no and": ("domain", PRECONDITION, "(at ?c ?x) (path ?x ?y)", "syntax", "(and ("),
    "no and in the goal": (
        "problem",
        "(and (moist roses) (moist herbs))",
        "(moist roses) (moist herbs)",
        "syntax",
        "(and (",
    ),
    "a list": ("problem", "(and (moist roses)", "((moist roses)", "syntax", "(and ("),
    "no types": ("domain", *NO_TYPES, "missing-section", "(:types can bed)"),
    "no colon": ("domain", ":strips :typing", "strips typing", "unknown-requirement", ":strips"),
    "underscore": ("domain", ":typing", ":typing :negative_preconditions", "unknown-requirement", ":negative-"),
    "an object in the domain": (
        "domain",
        "(full ?c))",
        "(full ?c) (path roses ?b) (path ?b roses))",
        "unknown-object",
        "roses - bed",
    ),
    "objects in the domain": (
        "domain",
        "  (:predicates",
        "  (:objects barrel - can)\n  (:predicates",
        "unknown-section",
        ":constants",
    ),
    "blank in an action": ("domain", "(:action carry", "(:action carry can", "bad-name", "carry-can"),
    "blank in a problem": ("problem", "(problem june)", "(problem june 1)", "bad-name", "june-1"),
    "marks of objects": ("problem", "(:objects tin", "(:objects ?tin", "bad-name", '"tin"'),
    "no mark": ("domain", "(at ?c ?b)", "(at ?c b)", "unknown-object", '"?b"'),
    "no parentheses": ("domain", "(?c - can ?b - bed)\n", "?c - can ?b - bed\n", "syntax", "(?x - type)"),
    "brackets": ("domain", "(?c - can ?b - bed)\n", "[?c - can ?b - bed]\n", "other-notation", '"("'),
    "no colon of a section": ("domain", "(:types can bed)", "(types can bed)", "unknown-section", ":types"),
    "no colon of an action": ("domain", "(:action pour", "(action pour", "unknown-section", ":action"),
    "comments of TeX": ("domain", "  (:types", "  % two types\n  (:types", "foreign-text", '";"'),
    "thoughts": ("domain", "(define (domain", "I (define) it:\n(define (domain", "foreign-text", "remove"),
    "no (define": ("domain", "(define (domain garden)", "(domain garden)", "syntax", "(define (domain"),
    "no parenthesis at the beginning": ("domain", "(define (domain", "define (domain", "syntax", "(define"),
    "no parenthesis at the beginning of a problem": ("problem", "(define (pro", "Define (pro", "syntax", "(define"),
    "objects twice": (
        "problem",
        "roses herbs - bed)",
        "roses - bed)\n  (:objects herbs - bed) ; more",
        "duplicate-section",
        "join",
    ),
    "predicates twice": (
        "domain",
        " (moist ?b - bed))",
        ")\n  (:predicates ; more\n    (moist ?b - bed) ; wet\n  )",
        "duplicate-section",
        "join",
    ),
    "no (domain": ("domain", "(domain garden)", "domain garden", "syntax", "(domain garden)"),
    "no :domain": ("problem", "  (:domain garden)\n", "", "missing-section", "(:domain garden)"),
    "order of an action": (
        "domain",
        f"    :precondition {PRECONDITION}\n    :effect (and (at ?c ?y) (not (at ?c ?x))))",
        f"    :effect (and (at ?c ?y) (not (at ?c ?x)))\n    :precondition {PRECONDITION})",
        "section-order",
        "before",
    ),
    "order of a problem": (
        "problem",
        "  (:domain garden)\n  (:objects tin jug - can roses herbs - bed)",
        "  (:objects tin jug - can roses herbs - bed)\n  (:domain garden)",
        "section-order",
        "before",
    ),
    "types of all lines above": (
        "domain",
        "(:types can bed)",
        "(:types\n can\n bed\n herb_bed - bed)",
        "type-cycle",
        '"- object"',
    ),
    "types of one line": ("domain", "(:types can bed)", "(:types can bed herb_bed - bed)", "type-cycle", '"- object"'),
    "its own parent": ("domain", "(:types can bed)", "(:types can bed - bed)", "type-cycle", '"bed" too'),
    "its own only parent": ("domain", "(:types can bed)", "(:types bed - bed can)", "type-cycle", "bed - object"),
    "entities": ("domain", "?c - can ?b - bed)", "?c&nbsp;&#45; can ?b - bed)", "foreign-text", ">"),
    "entities of entities": ("problem", "jug - can", "jug &amp;#45; can", "foreign-text", "signs"),
    "tags": ("domain", DOMAIN, f'<pre><code class="language-pddl">{DOMAIN}</code></pre>', "foreign-text", "remove"),
    "thoughts in tags": (
        "domain",
        "(define (domain",
        "<think>\nShall it be (define (domain garden) (:types can))?\n</think>\n(define (domain",
        "foreign-text",
        "remove",
    ),
    "ends of lines of HTML": ("problem", "jug - can", "jug - can<br/>", "foreign-text", "remove"),
    "quotes": ("problem", "tin jug - can", '"tin" "jug" - can', "foreign-text", "remove"),
    "quotes of a printer": ("problem", "(full tin)", "(full \u2018tin\u2019)", "foreign-text", "remove"),
    "a description": (
        "domain",
        "(:action pour\n",
        '(:action pour\n    :description "Water a bed"\n',
        "foreign-text",
        '";"',
    ),
    "a description on a line": (
        "domain",
        "(:action pour\n",
        '(:action pour :documentation "Water a bed (once)" ',
        "foreign-text",
        '";"',
    ),
    "marks of the shell": ("domain", "(?c - can ?b - bed)\n", "($c - can ?b - bed)\n", "foreign-text", '"?"'),
    "backslashes": ("domain", "  (:types can bed)", "  \\(:types can bed\\)", "foreign-text", "remove"),
    "backslashes in names": ("domain", "(moist ?b)))", "(moi\\st ?b)))", "other-notation", "moist"),
    "a sentence within": (
        "domain",
        "  (:action pour",
        "  This action waters\n  beds\n  (:action pour",
        "foreign-text",
        '";"',
    ),
    "a remark within": ("problem", "  (:init", "  now the state (:init", "foreign-text", '";"'),
    "dashes of a printer": ("domain", "(?c - can ?b - bed)\n", "(?c \u2013 can ?b \u2013 bed)\n", "look-alike", '"-"'),
    "logic": ("domain", "(and (at ?c ?b)", "(\u2227 (at ?c ?b)", "other-notation", "and"),
    "logic of effects": (
        "domain",
        "(and (at ?c ?y) (not (at ?c ?x)))",
        "(and (at ?c ?y) (\u00ac (at ?c ?x)))",
        "other-notation",
        "not",
    ),
    "unequal as a sign": ("domain", "(path ?x ?y))\n", "(path ?x ?y) (?x \u2260 ?y))\n", "other-notation", "(not (="),
    "true": ("domain", ":effect (moist ?b)", ":effect (= (moist ?b) true)", "other-notation", "(moist ?b)"),
    "false": (
        "domain",
        "(not (at ?c ?x))",
        "(assign (at ?c ?x) false)",
        "other-notation",
        "(not (at ?c ?x))",
    ),
    "true in a condition": ("domain", "(full ?c))\n", "(= (full ?c) true))\n", "other-notation", "(full ?c)"),
    "times": ("domain", "(full ?c))\n", "(at start (full ?c)))\n", "other-notation", "alone"),
    "times of effects": (
        "domain",
        ":effect (moist ?b)",
        ":effect (and (at end (moist ?b)))",
        "other-notation",
        "alone",
    ),
    "a type of nothing": ("domain", "(:types can bed)", "(:types can bed - object - object)", "syntax", "remove"),
    "types without a word": ("domain", "(moist ?b - bed)", "(moist ?b - (can bed))", "syntax", "(either can bed)"),
    "no blanks": ("domain", "(?c - can ?b - bed)\n", "(?c-can ?b-bed)\n", "other-notation", "?c - can"),
    "no blanks in a declaration": ("domain", "(moist ?b - bed)", "(moist ?b-bed)", "other-notation", "?b - bed"),
    "types before variables": ("domain", "(?c - can ?b - bed)\n", "(can ?c bed ?b)\n", "other-notation", "?c - can"),
    "a type before a variable": ("domain", "(moist ?b - bed)", "(moist bed ?b)", "other-notation", "?b - bed"),
    "types in the initial state": (
        "problem",
        "(at tin roses)",
        "(at tin - can roses - bed)",
        "other-notation",
        "remove",
    ),
    "types in a condition": ("domain", "(and (at ?c ?b)", "(and (at ?c - can ?b)", "other-notation", "remove"),
    "parentheses of types": ("domain", "(:types can bed)", "(:types (can bed))", "other-notation", "a b - type"),
    "parentheses of variables": (
        "domain",
        "(?c - can ?b - bed)\n",
        "((?c - can) (?b - bed))\n",
        "other-notation",
        "a b - type",
    ),
    "parentheses of objects": (
        "problem",
        "tin jug - can roses herbs - bed",
        "(tin jug - can) (roses herbs - bed)",
        "other-notation",
        "a b - type",
    ),
    "quantified without parentheses": (
        "problem",
        "(and (moist roses) (moist herbs))",
        "(forall ?b - bed (moist ?b))",
        "syntax",
        "(?x - type)",
    ),
    "quantified without and": (
        "problem",
        "(and (moist roses) (moist herbs))",
        "(exists (?b - bed) (moist ?b) (moist herbs))",
        "syntax",
        "(and",
    ),
    "effects quantified without and": (
        "domain",
        ":effect (moist ?b)",
        ":effect (forall (?b2 - bed) (moist ?b2) (moist ?b))",
        "syntax",
        "(and",
    ),
    "no parameters": (
        "domain",
        "    :parameters (?c - can ?b - bed)\n    :precondition (and (at ?c ?b)",
        "    :precondition (and (at ?c ?b)",
        "free-variable",
        ":parameters (?c - can ?b - bed)",
    ),
    "empty parameters": (
        "domain",
        "(?c - can ?b - bed)\n    :precondition (and (at ?c ?b)",
        "()\n    :precondition (and (at ?c ?b)",
        "free-variable",
        ":parameters (?c - can ?b - bed)",
    ),
    "objects without types": (
        "problem",
        "tin jug - can roses herbs - bed",
        "tin jug roses herbs",
        "wrong-type",
        "tin jug - can",
    ),
    "some objects without types": (
        "problem",
        "tin jug - can roses herbs - bed",
        "tin jug - can roses herbs",
        "wrong-type",
        "roses herbs - bed",
    ),
    "an atom that is not closed": (
        "problem",
        "(at tin roses) (at jug",
        "(at tin roses (at jug",
        "unclosed-parenthesis",
        "behind it",
    ),
    "a condition that is not closed": (
        "domain",
        "(and (at ?c ?x) (path ?x ?y))",
        "(and (at ?c ?x (path ?x ?y))",
        "unclosed-parenthesis",
        "behind it",
    ),
    "a problem called a domain": ("problem", "(problem june)", "(domain june)", "syntax", "(define (problem june)"),
    "a semicolon in a list": (
        "domain",
        "(path ?x ?y - bed) (full",
        "(path ?x ?y - bed); (full",
        "other-notation",
        "it",
    ),
    "a semicolon at an end": ("domain", "(not (at ?c ?x))))", "(not (at ?c ?x));))", "other-notation", "remove"),
    "numbers of lines": (
        "domain",
        DOMAIN,
        "".join(f"{number:3} {line}\n" for number, line in enumerate(DOMAIN.splitlines(), start=1)),
        "foreign-text",
        "remove",
    ),
    "a quoted mail": (
        "problem",
        PROBLEM,
        "".join(f"> {line}\n" for line in PROBLEM.splitlines()),
        "foreign-text",
        "remove",
    ),
    "a compared text": (
        "problem",
        PROBLEM,
        PROBLEM.replace("\n", "\n+")[:-1].join(("+", "\n")),
        "foreign-text",
        "remove",
    ),
    "not written together": ("domain", "(not (at ?c ?x))", "(!at ?c ?x)", "other-notation", "(not (at ?c ?x))"),
    "not without parentheses": ("domain", "(not (at ?c ?x))", "(not at ?c ?x)", "syntax", "(not (at ?c ?x))"),
    "requirements in parentheses": ("domain", ":strips :typing)", "(:strips :typing))", "syntax", "remove"),
    "two pairs of parentheses": ("domain", "(moist ?b - bed)", "((moist ?b - bed))", "syntax", "remove"),
    "no predicates": (
        "domain",
        "  (:predicates (at ?c - can ?b - bed) (path ?x ?y - bed) (full ?c - can) (moist ?b - bed))\n",
        "",
        "missing-section",
        "(:predicates (at ?c - can ?x - bed)",
    ),
    "another keyword of an action": (
        "domain",
        ":effect (moist ?b)",
        ":result (moist ?b)",
        "unknown-keyword",
        ":effect",
    ),
    "a keyword cut short": (
        "domain",
        ":precondition (and (at ?c ?b)",
        ":pre (and (at ?c ?b)",
        "unknown-keyword",
        ":prec",
    ),
    "a keyword of durative actions": (
        "domain",
        ":precondition (and (at ?c ?b)",
        ":condition (and (at ?c ?b)",
        "unknown-keyword",
        ":precondition",
    ),
    "operators": ("domain", DOMAIN, DOMAIN.replace(":action", ":operator"), "unknown-section", ":action"),
    "another name of a section": ("problem", "(:init", "(:initial-state", "unknown-section", ":init"),
    "define misspelt": ("domain", "(define", "(defien", "syntax", "define"),
    "domain misspelt": ("domain", "(domain garden)", "(domian garden)", "syntax", "domain"),
    "problem misspelt": ("problem", "(problem june)", "(porblem june)", "syntax", "problem"),
    "requirements misspelt": ("domain", "(:requirements", "(:requirement", "unknown-section", ":requirements"),
    "keywords without colons": (
        "domain",
        DOMAIN,
        DOMAIN.replace(":parameters", "parameters"),
        "unknown-keyword",
        ":par",
    ),
    "comments of SQL": ("domain", "(full ?c - can)", "(full ?c - can) -- with water\n", "foreign-text", '";"'),
    "unequal without parentheses": (
        "domain",
        "(path ?x ?y))\n",
        "(path ?x ?y) ?x != ?y)\n",
        "other-notation",
        "(not (= ?x ?y))",
    ),
    "equal without parentheses": (
        "domain",
        "(path ?x ?y))\n",
        "(path ?x ?y) (not ?x = ?y))\n",
        "other-notation",
        "(= ?x ?y)",
    ),
    "and between conditions": (
        "domain",
        ":precondition (and (at ?c ?x) (path ?x ?y))",
        ":precondition (at ?c ?x) and (path ?x ?y)",
        "other-notation",
        "(and",
    ),
    "and between goals": (
        "problem",
        "(and (moist roses) (moist herbs))",
        "(moist roses) && (moist herbs)",
        "other-notation",
        "(and",
    ),
    "and called": (
        "domain",
        PRECONDITION,
        "and(at(?c, ?x), path(?x, ?y))",
        "other-notation",
        "(at ?c ?x)",
    ),
    "a goal without parentheses": (
        "problem",
        "(and (moist roses) (moist herbs))",
        "moist roses",
        "syntax",
        "(moist roses)",
    ),
    "an effect without parentheses": ("domain", ":effect (moist ?b)", ":effect moist ?b", "syntax", "(moist ?b)"),
    "atoms of :init without parentheses": (
        "problem",
        "(at tin roses) (at jug herbs) (full tin)",
        "at tin roses\n at jug herbs\n (full tin)",
        "syntax",
        "(at tin roses)",
    ),
    "parentheses around :init": (
        "problem",
        "(:init (at tin roses) (at jug herbs) (full tin) (path roses herbs))",
        "(:init ((at tin roses) (at jug herbs) (full tin) (path roses herbs)))",
        "syntax",
        "remove",
    ),
    "true in :init": ("problem", "(full tin)", "(= (full tin) true)", "other-notation", "(full tin)"),
    "no value of a keyword": (
        "domain",
        ":precondition (and (at ?c ?b) (full ?c))",
        ":precondition",
        "syntax",
        ":precondition (and)",
    ),
    "no value of :parameters": (
        "domain",
        "(?c - can ?b - bed)\n    :precondition (and (at ?c ?b)",
        "\n    :precondition (and (at ?c ?b)",
        "free-variable",
        ":parameters (?c - can ?b - bed)",
    ),
    "an undeclared type": ("domain", "(:types can bed)", "(:types can)", "unknown-type", 'add "bed"'),
    "a predicate of two words": (
        "domain",
        "(at ?c - can ?b - bed)",
        "(at ?c - can ?b - bed) (is wet ?b - bed)",
        "bad-name",
        "is-wet",
    ),
    "parameters without their keyword": (
        "domain",
        ":parameters (?c - can ?b - bed)",
        "(?c - can ?b - bed)",
        "syntax",
        ":parameters (?c",
    ),
    "parameters without anything": (
        "domain",
        "(:action pour\n    :parameters (?c - can ?b - bed)",
        "(:action pour ?c - can ?b - bed",
        "syntax",
        ":parameters (?c",
    ),
    "not between conditions": (
        "problem",
        "(and (moist roses) (moist herbs))",
        "(and (moist roses) not (moist herbs))",
        "other-notation",
        "(not (moist herbs))",
    ),
    "effects that are added and deleted": (
        "domain",
        "(and (at ?c ?y) (not (at ?c ?x)))",
        "(and (at ?c ?y) (delete (at ?c ?x)))",
        "other-notation",
        "not",
    ),
    "if and then": (
        "domain",
        DOMAIN,
        DOMAIN.replace(":typing)", ":typing :conditional-effects)").replace(
            ":effect (moist ?b)", ":effect (when (full ?c) then (moist ?b))"
        ),
        "other-notation",
        "remove",
    ),
    "arrows before types": ("problem", "tin jug - can", "tin jug -> can", "other-notation", "name - type"),
    "equations of types": ("problem", "tin jug - can", "tin jug = can", "other-notation", "name - type"),
    "a predicate with a value": ("problem", "(at tin roses)", "(= (at tin) roses)", "other-notation", "(at tin roses)"),
    "an atom with a full stop": ("problem", "(full tin)", "(full tin).", "syntax", "remove"),
    "a predicate without parentheses": (
        "domain",
        "(full ?c - can) ",
        "\n full ?c - can\n ",
        "syntax",
        "(full ?c - can)",
    ),
    "a predicate twice": ("domain", "(full ?c - can)", "(full ?c - can) (full ?c - can)", "duplicate-name", "remove"),
    "an object twice": ("problem", "tin jug - can", "tin jug tin - can", "duplicate-name", "remove"),
    "something left out": ("domain", "  (:action pour", "  ...\n  (:action pour", "syntax", "write it"),
    "a text of one word": (
        "domain",
        "(:action pour\n",
        '(:action pour\n    :description "Watering"\n',
        "foreign-text",
        '";"',
    ),
    "a beginning twice": (
        "domain",
        "(define (domain garden)",
        "(define (domain garden)\n(define (domain garden)",
        "two-definitions",
        "remove",
    ),
    "names of two words in quotes": (
        "problem",
        "(problem june)",
        '(problem "first of june")',
        "foreign-text",
        "remove",
    ),
    "an arrow": ("domain", ":effect (moist", ":effect => (moist", "other-notation", "remove"),
    "variables without marks": (
        "domain",
        "(?c - can ?x ?y - bed)\n    :precondition (and (at ?c ?x) (path ?x ?y))\n    :effect (and (at ?c ?y)",
        "(c - can x y - bed)\n    :precondition (and (at c x) (path x y))\n    :effect (and (at c y)",
        "bad-name",
        "?c",
    ),
    "plural": (
        "domain",
        ":precondition (and (at ?c ?b)",
        ":preconditions (and (at ?c ?b)",
        "unknown-keyword",
        ":precondition",
    ),
}

# The same, where only the author knows the repair.
TOLD = {
    "a goal behind the problem": (
        "problem",
        "herbs))\n  (:goal (and (moist roses) (moist herbs))))",
        "herbs)))\n  (:goal (and (moist roses) (moist herbs)))",
        "extra-parenthesis",
        "end of the file",
    ),
    "an object of two types": ("problem", "jug - can", "jug - can tin - bed", "duplicate-name", "rename"),
    "a predicate of two types": (
        "domain",
        "(full ?c - can)",
        "(full ?c - can) (full ?b - bed)",
        "duplicate-name",
        "rename",
    ),
    "a variable in the goal": ("problem", "(moist roses)", "(moist ?b)", "free-variable", "exists (?b - bed)"),
    "undeclared": (
        "domain",
        ":effect (moist ?b)",
        ":effect (and (moist ?b) (not (dry ?b)))",
        "unknown-predicate",
        "(dry ?b - bed)",
    ),
    "arity": ("domain", "(at ?c - can ?b - bed)", "(at ?c - can)", "wrong-arity", "(at ?c)"),
    "a typed problem of an untyped domain": (
        "domain",
        DOMAIN,
        "(define (domain garden) (:predicates (at ?c ?b) (path ?x ?y) (full ?c) (moist ?b)))\n",
        "unknown-type",
        "(:types can bed)",
    ),
    "types before objects": (
        "problem",
        "tin jug - can roses herbs - bed",
        "can - tin jug bed - roses herbs",
        "unknown-type",
        "tin - can",
    ),
    "predicates in a problem": ("problem", "  (:init", "  (:predicates (wet))\n  (:init", "unknown-section", "domain"),
    "lists of effects": (
        "domain",
        ":effect (and (at ?c ?y) (not (at ?c ?x)))",
        ":add (at ?c ?y) :delete (at ?c ?x)",
        "unknown-keyword",
        ":effect (and",
    ),
    "effects that are added": ("domain", ":effect (moist ?b)", ":add_effects (moist ?b)", "unknown-keyword", ":effect"),
    "an unknown part": ("domain", ":effect (moist ?b)", ":effect (moist ?b) :agent ?a - can", "not-supported", ""),
    "an action in the goal": ("problem", "(moist herbs)", "(pour jug herbs)", "unknown-predicate", "(moist ...)"),
    "predicates without parentheses": (
        "domain",
        "(:predicates (at ?c - can ?b - bed)",
        "(:predicates at full (at ?c - can ?b - bed)",
        "syntax",
        "(at ?x - type)",
    ),
    "a merge": (
        "domain",
        "    :effect (moist ?b)))",
        "<<<<<<< HEAD\n    :effect (moist ?b)))\n=======\n    :effect (and (moist ?b))))\n>>>>>>> other",
        "foreign-text",
        "one of the two",
    ),
    "numbers compared": (
        "domain",
        "(full ?c))\n",
        "(full ?c) (weight ?c) >= 2)\n",
        "not-supported",
        "before their terms",
    ),
    "numbers compared in parentheses": (
        "domain",
        "(full ?c))\n",
        "(full ?c) ((weight ?c) >= 2))\n",
        "not-supported",
        "before their terms",
    ),
    "numbers assigned": (
        "domain",
        ":effect (moist ?b)",
        ":effect (and (moist ?b) (weight ?c) -= 1)",
        "not-supported",
        "total-cost",
    ),
    "durative actions": ("domain", DOMAIN, DOMAIN.replace(":action", ":durative-action"), "not-supported", ""),
    "two types that are ancestors": (
        "domain",
        "(:types can bed)",
        "(:types can - bed bed - can)",
        "type-cycle",
        "another",
    ),
    "a name that is commented out": (
        "problem",
        "roses herbs - bed",
        "roses - bed ; herbs - bed\n",
        "unknown-object",
        "begins a comment",
    ),
    "a type near by chance": ("domain", "(:types can bed)", "(:types can bend)", "unknown-type", "bend"),
    "a domain without anything": (
        "domain",
        DOMAIN,
        "(define (domain garden) (:types can bed))\n",
        "unknown-predicate",
        "domain",
    ),
    "left out": ("problem", "(path roses herbs))", "(path roses herbs) ...)", "syntax", "left out"),
}


def _written(folder: Path, file: str, old: str, new: str) -> list[Path]:
    texts = {"domain": DOMAIN, "problem": PROBLEM}
    assert old in texts[file]
    texts[file] = texts[file].replace(old, new)
    paths = [folder / f"{name}.pddl" for name in texts]
    for path, text in zip(paths, texts.values(), strict=True):
        path.write_text(text)
    return paths


def _wrong(found: tuple[Diagnostic, ...]) -> list[Diagnostic]:
    return [
        d for d in found if d.severity is Severity.ERROR or d.code in ("section-order", "constant-again", "nested-init")
    ]


def test_a_habit_is_told_once_for_all_actions(tmp_path: Path) -> None:
    paths = _written(tmp_path, "domain", DOMAIN, DOMAIN.replace(":effect", ":effects"))
    (told,) = _wrong(check_paths(paths).diagnostics)
    assert told.code == "unknown-keyword" and len(told.edits) == 2
    assert _wrong(check_paths(paths, fix=True).diagnostics) == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("(not (at ?c ?x))", "(not(at ?c ?x))"),
        (f":precondition {PRECONDITION}", ":precondition(and(at ?c ?x)(path ?x ?y))"),
        (":effect (moist ?b)", ":effect(moist ?b)"),
        (":typing)", ":typing :universal-preconditions)"),
        (":effect (moist ?b)", ":effect (and(moist ?b)(not(full ?c)))"),
    ],
)
def test_blanks_before_parentheses_may_be_left_out(tmp_path: Path, old: str, new: str) -> None:
    assert check_paths(_written(tmp_path, "domain", old, new)).diagnostics == ()


@pytest.mark.parametrize("value", ["(length roses herbs 2)", "(length roses herbs) = 2", "(= 2 (length roses herbs))"])
def test_values_are_written_with_an_equation(tmp_path: Path, value: str) -> None:
    costly = DOMAIN.replace("  (:action carry", "  (:functions (total-cost) (length ?x ?y - bed))\n  (:action carry")
    costly = costly.replace("(not (at ?c ?x))", "(not (at ?c ?x)) (total-cost) += (length ?x ?y)")
    paths = _written(tmp_path, "domain", DOMAIN, costly.replace(":typing)", ":typing :action-costs)"))
    paths[1].write_text(PROBLEM.replace("(path roses herbs))", f"(path roses herbs) {value})"))
    told = _wrong(check_paths(paths).diagnostics)
    assert [d.code for d in told] == ["other-notation"] * 2
    assert {d.hint for d in told} >= {"write (= (length roses herbs) 2)"}
    assert _wrong(check_paths(paths, fix=True).diagnostics) == []
    assert "(increase (total-cost) (length ?x ?y))" in paths[0].read_text()


@pytest.mark.parametrize("name", REPAIRED)
def test_a_slip_is_told_once_and_repaired(tmp_path: Path, name: str) -> None:
    *change, kind, hint = REPAIRED[name]
    paths = _written(tmp_path, *change)
    (told,) = _wrong(check_paths(paths).diagnostics)
    assert told.code == kind and hint in (told.hint or "")
    assert _wrong(check_paths(paths, fix=True).diagnostics) == []


@pytest.mark.parametrize("name", TOLD)
def test_a_slip_is_told_once_with_its_cure(tmp_path: Path, name: str) -> None:
    *change, kind, hint = TOLD[name]
    (told,) = _wrong(check_paths(_written(tmp_path, *change)).diagnostics)
    assert told.code == kind and hint in (told.hint or "")


@pytest.mark.parametrize(
    ("text", "cure"),
    [
        ("<!DOCTYPE html>\n<html><body>(define (domain garden))</body></html>\n", "download"),
        ("<html>\n", "download"),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 120\n", "git lfs pull"),
        ("404: Not Found", "address"),
        ('{"domain": "garden", "actions": []}\n', "define"),
        (json.dumps({"domain": DOMAIN, "problem": PROBLEM}), "definition"),
        (json.dumps([DOMAIN]), "definition"),
        ("from unified_planning.shortcuts import *\n", "define"),
        ('<?xml version="1.0"?>\n<pddl/>\n', "define"),
        ("Sorry, there is no such domain.\n", "define"),
    ],
)
def test_a_file_of_another_kind_is_named(tmp_path: Path, text: str, cure: str) -> None:
    paths = _written(tmp_path, "domain", DOMAIN, text)
    (told,) = check_paths(paths).diagnostics
    assert told.code == "empty-file" and cure in (told.hint or "")


def test_an_object_of_the_domain_moves_from_the_problem(tmp_path: Path) -> None:
    paths = _written(tmp_path, "domain", "(full ?c))", "(full ?c) (path roses ?b) (path ?b herbs))")
    check_paths(paths, fix=True)
    assert "(:constants roses - bed herbs - bed)" in paths[0].read_text()
    assert "(:objects tin jug - can)" in paths[1].read_text()


def test_a_list_of_types_is_ended_before_those_of_its_type(tmp_path: Path) -> None:
    paths = _written(tmp_path, "domain", "(:types can bed)", "(:types\n  can\n  mulch\n  bed\n  herb_bed - bed)")
    paths[1].write_text(PROBLEM.replace("roses herbs - bed", "roses - mulch herbs - herb_bed"))
    assert _wrong(check_paths(paths, fix=True).diagnostics) == []
    assert "(:types\n  can\n  bed - object mulch\n  herb_bed - bed)" in paths[0].read_text()


def test_numbers_are_compared_as_in_html(tmp_path: Path) -> None:
    paths = _written(tmp_path, "domain", "(full ?c))", "(full ?c) (&gt;= (weight ?c) 2)) ; 3 &gt; 2")
    told = {d.code: d for d in _wrong(check_paths(paths).diagnostics)}
    assert told.keys() == {"foreign-text", "not-supported"} and '">="' in told["not-supported"].message
    check_paths(paths, fix=True)
    assert "(>= (weight ?c) 2)) ; 3 &gt; 2" in paths[0].read_text()


def test_a_new_file_never_replaces_one(tmp_path: Path) -> None:
    paths = _written(
        tmp_path, "problem", "herbs))))\n", "herbs))))\n(define (problem july) (:domain garden) (:goal (and)))\n"
    )
    before = paths[1].read_text()
    (tmp_path / "july.pddl").write_text("; mine\n")
    check_paths(paths, fix=True)
    assert paths[1].read_text() == before and (tmp_path / "july.pddl").read_text() == "; mine\n"


def test_a_comment_may_be_latin_1(tmp_path: Path) -> None:
    paths = _written(tmp_path, "domain", "garden)\n", "garden) ; Beete begie\u00dfen\n")
    paths[0].write_bytes(paths[0].read_text().encode("latin-1"))
    assert [d.code for d in check_paths(paths).diagnostics] == ["latin1-comment"]
    assert check_paths(paths, fix=True).diagnostics == ()
    assert "begie\u00dfen" in paths[0].read_text(encoding="utf-8")


def test_a_cost_without_a_value_is_a_warning(tmp_path: Path) -> None:
    costly = DOMAIN.replace(":typing)", ":typing :action-costs)").replace(
        "  (:action carry", "  (:functions (total-cost) (length ?x ?y - bed))\n  (:action carry"
    )
    costly = costly.replace("(not (at ?c ?x))", "(not (at ?c ?x)) (increase (total-cost) (length ?x ?y))")
    paths = _written(tmp_path, "domain", DOMAIN, costly)
    for values, told in (("", ["cost-missing"]), (" (= (length roses herbs) 2)", [])):
        problem = PROBLEM.replace("(path roses herbs))", f"(path roses herbs){values})").replace(
            "herbs))))", "herbs)))\n  (:metric minimize (total-cost)))"
        )
        paths[1].write_text(problem)
        assert [d.code for d in check_paths(paths).diagnostics] == told


@given(
    st.lists(
        st.sampled_from(
            ["```", "(", ")", ",", "at(", "!=", "#|", "|#", ";", "\n", ":init", "nil", "?c:", "(define", " "]
        )
    ),
    st.integers(0, len(DOMAIN)),
)
def test_repairing_ends_and_keeps_to_pddl(
    tmp_path_factory: pytest.TempPathFactory, words: list[str], place: int
) -> None:
    path = tmp_path_factory.mktemp("mixed") / "domain.pddl"
    path.write_text(DOMAIN[:place] + "".join(words) + DOMAIN[place:])
    check_paths([path], fix=True)
    once = path.read_text()
    check_paths([path], fix=True)
    assert path.read_text() == once


def test_a_constant_twice_is_no_fault_of_a_problem_without_types(tmp_path: Path) -> None:
    domain = "(define (domain garden) (:constants rake rake) (:predicates (at ?c ?b) (full ?c)))\n"
    paths = _written(tmp_path, "domain", DOMAIN, domain)
    told = check_paths(paths).diagnostics
    assert "duplicate-name" in {d.code for d in told if d.location.file == str(paths[0])}
    assert "duplicate-name" not in {d.code for d in told if d.location.file == str(paths[1])}
