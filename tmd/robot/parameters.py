"""Parameters of motions and skills, in one place: what to look at when the robot is tuned.

Metres, radians, newtons and seconds unless it says otherwise. Sequences are tried in order, best first.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class StanceParameters:
    """Where the base is looked for from which a hand gets to something."""

    distances: tuple[float, ...] = (0.62, 0.54, 0.70, 0.80, 0.48, 0.90, 1.0)
    """Metres from the base to what is to be reached, best first."""
    low: float = 0.35
    """Metres from the floor below which what is to be reached is near the base."""
    low_distances: tuple[float, ...] = (0.5, 0.46, 0.42, 0.56, 0.38, 0.62, 0.7)
    """Metres from the base to that, best first: straight down to the floor the arms reach 0.44 m ahead."""
    bearings: tuple[float, ...] = (0.0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9, 1.2, -1.2)
    """Radians off the front of what is to be reached, best first."""
    turns: tuple[float, ...] = (0.0, 0.35, -0.35)
    """Radians that the base is turned away from what it faces, so that a shoulder does."""
    fine_distances: tuple[float, ...] = (0.44, 0.51, 0.58, 0.66, 0.74, 0.82, 0.90, 0.98)
    """The same where furniture leaves little room: metres."""
    low_fine_distances: tuple[float, ...] = (0.44, 0.41, 0.47, 0.38, 0.36)
    """The same for what is low: metres."""
    fine_turns: tuple[float, ...] = (0.0, 0.35, -0.35, 0.7, -0.7)
    """The same where furniture leaves little room: radians."""
    shoulder_above_hand: tuple[float, ...] = (0.10, 0.32, -0.1)
    """Metres from the hand's height to the shoulder's, best first."""
    search_budget: int = 6000
    """What a search may cost before it ends: about so many milliseconds."""
    prices: tuple[int, ...] = (3, 15, 40)
    """Cost of a pose that has no posture, one whose postures collide, and a motion; same unit."""
    alike: float = 0.15
    """Metres between places that count as one."""
    max_tries: int = 6
    """Maximum number of stances tried per skill."""
    clearances: tuple[tuple[float, float], ...] = ((0.05, 1.0), (0.02, 0.4), (0.008, 0.4))
    """Metres that the base keeps from things, best first, and its pace there: with less clearance it drives
    exactly."""
    max_postures: int = 8
    """Postures of one pose that are looked at."""
    torso_step: float = 0.04
    """Metres that the torso moves between two checks."""


@dataclass(frozen=True, slots=True)
class GraspParameters:
    """Taking, lifting and putting down."""

    approach: float = 0.10
    """Metres from which a hand goes straight to what it takes."""
    approach_in_niche: float = 0.18
    """The same for what is in a niche or a cupboard."""
    max_opening_along: float = 0.3
    """Fingers that open more along a direction than this (cosine) do not pass a thing in it."""
    retreat: float = 0.06
    """Metres that a hand should get straight away from what it has put down."""
    min_alignment: float = 0.85
    """Cosine of the angle within which a hand points the way that it goes in."""
    lift: float = 0.10
    """Metres that a thing is lifted, or drawn out, before the arm moves freely."""
    release_heights: tuple[float, ...] = (0.006, 0.03)
    """Metres above a surface at which a thing is let go of, best first: fingers do not fit into every slot."""
    upright_heights: tuple[float, ...] = (0.003, 0.006, 0.012)
    """The same for what must stand: from higher up it lands on an edge and topples."""
    unfit: float = 0.1
    """Metres round a spot where something could not be done, in which things are not put down again."""
    widest: float = 0.078
    """Metres that the fingers get round."""
    level: float = 0.5
    """Sine of the angle to the ground up to which a side counts as level."""
    steep: float = 0.6
    """Cosine of the angle to straight down within which a hand comes from above."""
    above_ground: float = 0.006
    """Metres that the finger tips keep from what a thing lies on."""
    bar: float = 0.05
    """Metres that the fingers stand open for a handle, at most."""
    most_lying: int = 64
    """Grasps of a lying thing that are looked at."""
    tall: float = 0.12
    """Metres from which a thing is not a small one."""
    headings: int = 8
    """Number of headings tried for a thing that is put down."""
    knob_pin_offset: float = 0.015
    """Metres from the middle of a knob to the two points that the fingers hold it at."""
    lid_force: float = 1.0
    """Newtons that a lid is lifted with, so that what it is on neither slides nor tips over."""


@dataclass(frozen=True, slots=True)
class ArticulationParameters:
    """Doors, drawers, lids, handles, buttons and knobs."""

    approach: float = 0.09
    """Metres from which a hand goes straight to a handle or a button."""
    button_share: float = 0.79
    """The part of its way that a finger pushes a button down."""
    lid_gap: float = 0.02
    """Metres from the fingers to the lid between them."""
    pressed_share: float = 0.5
    """A button is pressed from this share of its way on."""
    waypoints: int = 8
    """Poses of the hand along the way of a door."""
    pushes: tuple[tuple[float, float], ...] = ((0.5, 1.0), (0.75, 1.0), (0.3, 1.0), (1.0, 1.0), (0.0, 0.5))
    """How a flap, or a door that is to be shut, is pushed."""
    open_shares: tuple[float, ...] = (1.0, 0.8, 0.65)
    """How far a door is opened, as a part of its way, best first."""
    partial_shares: tuple[float, ...] = (0.4, 0.25)
    """How far it is moved where it cannot be moved all the way at once."""
    stages: int = 4
    """Pieces that a way is divided into at most."""
    pulls: tuple[tuple[float, float], ...] = ((0.0, 1.0), (0.0, 0.5), (0.0, 0.0), (0.5, 1.0), (1.0, 1.0), (0.5, 0.5))
    """How a handle is held: at which part of its way the hand is square to it, and how far it keeps its heading."""
    lifts: tuple[tuple[float, float], ...] = ((0.0, 0.0), (0.5, 0.3), (0.5, 0.6), (0.0, 1.0), (1.0, 1.0))
    """The same for a lid: best is a hand that turns with it, for then nothing rubs on what nobody holds."""
    lid_penetration: float = 0.004
    """Metres that a lid may be in a hand on its way."""
    bearing: float = 0.45
    """Radians off its front from which a door is opened: it comes towards the robot."""
    open_from: float = 0.6
    """A joint is open from this share of its way on."""
    shut_to: float = 0.05
    """And shut up to this one; between the two it is neither, and counts as what it was."""
    setting_share: float = 0.25
    """A knob is at a setting when it is not farther from it than this share of the way to the next one."""
    retreats: tuple[float, ...] = (0.1, 0.05, 0.025)
    """Metres that a hand is drawn back from what it worked, best first."""
    sweep_step: float = 0.05
    """A door is looked at every so many radians (a drawer: metres)."""
    sweep_margin: float = 0.015
    """Metres that it must stay away: its edge then passes nothing unseen, not even a spoon in the other hand."""


@dataclass(frozen=True, slots=True)
class PouringParameters:
    """Pouring, and dipping a spoon."""

    heights: tuple[tuple[float, float], ...] = ((0.06, 0.0), (0.03, 0.0), (0.06, 0.015), (0.03, 0.02), (0.01, 0.02))
    """Metres between a rim and the mouth that is tipped over it, and from the middle of the rim to below the mouth
    on the hand's side, best first: under a spout there is little room."""
    tilts: tuple[float, ...] = (1.8, 1.3)
    """Radians by which a thing is tipped, best first."""
    swing: float = 0.5
    """Radians by which what hangs from the hand is swung."""
    dip_heights: tuple[float, ...] = (0.05, 0.02)
    """Metres above a rim from which a spoon goes down."""
    dip_depth: float = 0.02
    """Metres that a spoon goes below a rim."""
    dipped_from: float = 0.005
    """Metres below the rim from which it is in."""
    head_offset: float = 0.01
    """Metres from where a spoon pours to the middle of its head."""
    dip_leans: tuple[float, ...] = (0.9, 0.6, 0.3, 1.2, 0.0)
    """Radians by which a spoon is dipped with its end down, best first."""
    level_shares: tuple[float, ...] = (0.0, 0.33, 0.67, 1.0)
    """How it is leaned above the rim: parts of the whole lean, so that its end stays over the rim meanwhile."""
    rim_penetration: float = 0.003
    """Metres that a spoon may be in the rim."""
    outside_shares: tuple[float, ...] = (0.6, 0.8, 1.0)
    """How far an open thing is tipped before a niche, as a part of the whole: a half full one keeps what is in
    it."""
    runs_out_from: float = 1.2
    """Radians from which contents run out."""
    outside_margin: float = 0.85
    """How far it may be tipped there, as a part of the angle from which it spills."""
    wall: float = 0.005
    """Metres from the inside of a wall to the edge that contents leave over."""
    basin_depth: float = 0.08
    """Metres from the floor of a basin to its rim."""
    basin_places: int = 3
    """Places over a basin that are tried."""
    approach_in_niche: float = 0.18
    """Metres in front of a niche."""
    mouth_offset: float = 0.004
    """Metres that the mouth may be beside the opening of what it is held over: contents fall straight down."""
    max_ways: int = 6
    """Ways of pouring that are thought through for one stance."""
    headings: int = 8
    """Number of headings of the vessel that are tried."""
    stages: int = 4
    """Pieces that tipping is divided into."""


@dataclass(frozen=True, slots=True)
class BaseMotionParameters:
    """Driving and looking round."""

    max_stances: int = 8
    """Stances that a base drives to before it gives up."""
    steps_back: tuple[float, ...] = (0.0, 0.1, 0.2, 0.3, 0.45, 0.6)
    """Metres that a robot steps back, best first."""
    steps_aside: tuple[float, ...] = (0.0, 0.6, -0.6, 1.2, -1.2)
    """Radians off straight back, best first."""
    max_lookouts: int = 8
    """Places to look from that are tried."""
    brief_budget: int = 2000
    """What looking for a place from which a thing can be taken may cost: it may be taken from another one later."""
    head_radius: float = 0.45
    """Metres round the eye in which there is nothing but the robot."""
    tuck_steps_back: tuple[float, ...] = (0.12, 0.25, 0.4)
    """Metres that the base goes back where the arms have no room to be tucked."""
    grid_pitch: float = 0.1
    """Metres between neighbours of the grid."""
    grid_headings: int = 16
    """Headings of the grid."""
    clearance: float = 0.02
    """Metres that the way keeps from things, where its start and its goal do."""
    start_penetration: float = 0.03
    """Metres: the robot may be this deep in something where it starts (a door that springs open leans on it)."""
    near: float = 3.0
    """Strides from the ends of a way within which what touches there may touch."""
    rounding: float = 0.5
    """The part of the clearance that may be lost where corners are rounded."""
    ways_out: tuple[float, ...] = (0.0, 0.12, -0.12, 0.25, -0.25, 0.4, -0.4, 0.6, -0.6, 0.9, -0.9, 1.3, -1.3)
    """Radians off straight away from what is in the way, best first."""
    ways_out_lengths: tuple[float, ...] = (0.6, 0.4, 0.25)
    """Metres of such a way, best first."""
    max_ways_out: int = 3
    """Ways out that are tried."""
    block: int = 6
    """Side, in cells, of the blocks of the grid that are checked at once."""
    max_attempts: int = 20
    """Searches, each without the moves that turned out to be blocked."""
    escape_points: int = 200
    """Points looked at from the start, to see whether one gets away from there at all."""
    max_places: int = 8000
    """Places of the grid, whatever the heading, that are looked at: a room of 80 square metres."""
    turn_cost: float = 0.35
    """Metres that turning by one radian costs."""


@dataclass(frozen=True, slots=True)
class ArmMotionParameters:
    """Paths of an arm, tucked arms, and carrying."""

    clearance: float = 0.01
    """Metres that planned motions keep from things, where their start and their goal do."""
    start_penetration: float = 0.01
    """Metres: an arm may be this deep in something where it starts (contacts are soft), never deeper on its way."""
    near: float = 2.0
    """Strides from the ends of a way within which what touches there may touch."""
    rounding: float = 0.5
    """The part of the clearance that may be lost where corners are rounded."""
    max_branches: int = 12
    """Postures of a pose that a straight motion is tried with."""
    chunk: int = 8
    """Poses of a straight motion that are solved at once."""
    rrt_edge: float = 10.0
    """The longest edge of the tree, in strides."""
    level_edge: float = 4.0
    """The same for what is carried upright."""
    level_detours: tuple[tuple[float, float], ...] = (
        (0.0, 0.0), (0.0, 0.12), (0.08, 0.0), (0.08, 0.15), (0.0, 0.25), (0.2, 0.0), (0.2, 0.2), (0.35, 0.2),
    )  # fmt: skip
    """Metres up and towards the robot by which what is carried upright goes out of the way, best first."""
    level_clearance: float = 0.004
    """Metres that it keeps from things there."""
    level_planned: int = 3
    """Places to bring it to for which a way is searched at random, where none is straight."""
    level: float = 0.17
    """Radians that what can hold something may lean on its way (10 degrees), or a little more than at its ends."""
    rrt_shortcuts: int = 60
    """Attempts to shorten a path."""
    there: float = 0.03
    """Radians: an arm that is this near to its posture need not move."""
    tuck_shifts: tuple[float, ...] = (-0.1, 0.1, -0.2, 0.2, -0.3, 0.3)
    """Where an arm cannot be tucked as usual, one of its first joints is turned by so many radians."""
    max_shifted: int = 6
    """Joints of which that is tried."""
    max_folded: int = 2
    """Folded postures tried for each."""
    carrying_region: tuple[tuple[float, float], ...] = ((0.3, 0.56), (-0.05, 0.4), (0.9, 1.35))
    """Where a tool with something in it may be for driving, in the base's frame: ahead, to its side, up."""
    carrying_yaws: int = 8
    """Headings of what is carried that are tried."""
    max_carried: int = 12
    """Places tried for what is carried: an arm that gets to none of them is wedged in where it is."""
    tuck_samples: int = 300
    """Samples for the path of an arm that is tucked; a third of it for each place that something held is brought
    to."""


@dataclass(frozen=True, slots=True)
class InverseKinematicsParameters:
    """The inverse kinematics of an arm."""

    rolls: int = 48
    """Values of the free joint that are tried."""
    starts: int = 64
    """Starts of the numerical solver."""
    margin: float = 0.01
    """Radians that solutions keep from the limits, where a motor would push against the stop."""
    accuracy: tuple[float, ...] = (1e-4, 1e-3)
    """Metres and radians between the pose asked for and the one reached."""
    rounds: int = 60
    """Iterations of the numerical solver."""
    damping: float = 0.03
    """Of its least squares."""
    stride: float = 0.4
    """Radians that a joint moves in one iteration at most."""
    leap: float = 0.5
    """Radians that a joint may move between two poses of a motion."""
    smooth: float = 0.25
    """Radians that it may move without another roll being looked at."""


@dataclass(frozen=True, slots=True)
class ContactParameters:
    """What counts as touching."""

    touch: float = 1e-4
    """Metres: surfaces that are not deeper in each other than this do not collide."""
    apart: float = 0.003
    """Metres that what touched at an end of a way is apart once it has got away from there."""
    slack: float = 0.005
    """Metres: what rounding could refuse wrongly."""
    upright: float = 0.26
    """Radians: what leans more than this (15 degrees) does not stand."""
    repose: float = 0.35
    """Radians from which anything open spills: powder slides from about 35 degrees on, so this is careful."""
    stream: float = 0.007
    """Metres: the radius of what runs from a spout."""
    still: tuple[float, float] = (2e-4, 2e-3)
    """Metres and radians within which a thing lies still for a 20th of a second."""
    settled_after: int = 5
    """Looks, a 20th of a second apart, after which what lay still is at rest."""
    settle_checks: int = 80
    """Maximum number of looks."""


@dataclass(frozen=True, slots=True)
class MotorParameters:
    """Motors and grippers."""

    gain: float = 0.2
    """The part of a position error that a motor removes in one step."""
    yielding_share: float = 0.1
    """The share of its force that a yielding motor has."""
    check_every: int = 8
    """Steps between two checks of a track."""
    stalled_after: int = 120
    """Steps without getting nearer after which a motion is given up."""
    gripper_gap: float = 0.09
    """Metres between the fingers of an open hand."""
    grip_force: float = 30.0
    """Newtons."""
    finger_speed: float = 0.8
    """Radians per second."""
    finger_lag: float = 0.04
    """Radians that a finger may lag behind before it holds something."""


@dataclass(frozen=True, slots=True)
class TimeParameters:
    """How long things may take."""

    instruction: float = 40.0
    """Seconds of computing after which an instruction is given up, by the simulation's count of work: counted, so that
    a slow machine gets the same result."""


STANCE = StanceParameters()
GRASP = GraspParameters()
ARTICULATION = ArticulationParameters()
POURING = PouringParameters()
BASE_MOTION = BaseMotionParameters()
ARM_MOTION = ArmMotionParameters()
IK = InverseKinematicsParameters()
CONTACT = ContactParameters()
MOTOR = MotorParameters()
TIME = TimeParameters()
