"""Parameters of motions and skills, in one place: what to look at when the robot is tuned.

Metres, radians, newtons and seconds unless it says otherwise. Sequences are tried in order, best first.
"""

from __future__ import annotations

from typing import NamedTuple


class StanceParameters(NamedTuple):
    """Search for a base pose from which a hand gets to something."""

    # Metres from the base to what is to be reached, best first.
    distances: tuple[float, ...] = (0.62, 0.54, 0.70, 0.80, 0.48, 0.90, 1.0)
    # Metres from the floor below which what is to be reached is near the base.
    low: float = 0.35
    # Metres from the base to that, best first: straight down to the floor the arms reach 0.44 m ahead.
    low_distances: tuple[float, ...] = (0.5, 0.46, 0.42, 0.56, 0.38, 0.62, 0.7)
    # Radians off the front of what is to be reached, best first.
    bearings: tuple[float, ...] = (0.0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9, 1.2, -1.2)
    # Radians that the base is turned away from what it faces, so that a shoulder does.
    turns: tuple[float, ...] = (0.0, 0.35, -0.35)
    # The same where furniture leaves little room: metres.
    fine_distances: tuple[float, ...] = (0.44, 0.51, 0.58, 0.66, 0.74, 0.82, 0.90, 0.98)
    # The same for what is low: metres.
    low_fine_distances: tuple[float, ...] = (0.44, 0.41, 0.47, 0.38, 0.36)
    # The same where furniture leaves little room: radians.
    fine_turns: tuple[float, ...] = (0.0, 0.35, -0.35, 0.7, -0.7)
    # Metres from the hand's height to the shoulder's, best first.
    shoulder_above_hand: tuple[float, ...] = (0.10, 0.32, -0.1)
    # Budget of a search, in approximate milliseconds.
    search_budget: int = 6000
    # Cost of a pose that has no posture, one whose postures collide, and a motion; same unit.
    prices: tuple[int, ...] = (3, 15, 40)
    # Metres between places that count as one.
    alike: float = 0.15
    # Maximum number of stances tried per skill.
    max_tries: int = 6
    # Metres that the base keeps from things, best first, and its pace there: with less clearance it drives exactly.
    clearances: tuple[tuple[float, float], ...] = ((0.05, 1.0), (0.02, 0.4), (0.008, 0.4))
    # Postures of one pose that are looked at.
    max_postures: int = 8
    # Metres that the torso moves between two checks.
    torso_step: float = 0.04


class GraspParameters(NamedTuple):
    """Taking, lifting and putting down."""

    # Metres from which a hand goes straight to what it takes.
    approach: float = 0.10
    # The same for what is in a niche or a cupboard.
    approach_in_niche: float = 0.18
    # Fingers that open more along a direction than this (cosine) do not pass a thing in it.
    max_opening_along: float = 0.3
    # Metres that a hand should get straight away from what it has put down.
    retreat: float = 0.06
    # Cosine of the angle within which a hand points the way that it goes in.
    min_alignment: float = 0.85
    # Metres that a thing is lifted, or drawn out, before the arm moves freely.
    lift: float = 0.10
    # Metres above a surface at which a thing is let go of, best first: fingers do not fit into every slot.
    release_heights: tuple[float, ...] = (0.006, 0.03)
    # The same for what must stand: from higher up it lands on an edge and topples.
    upright_heights: tuple[float, ...] = (0.003, 0.006, 0.012)
    # Metres round a spot where something could not be done, in which things are not put down again.
    unfit: float = 0.1
    # Metres that the fingers get round.
    widest: float = 0.078
    # Sine of the angle to the ground up to which a side counts as level.
    level: float = 0.5
    # Cosine of the angle to straight down within which a hand comes from above.
    steep: float = 0.6
    # Metres that the finger tips keep from what a thing lies on.
    above_ground: float = 0.006
    # Metres that the fingers stand open for a handle, at most.
    bar: float = 0.05
    # Grasps of a lying thing that are looked at.
    most_lying: int = 64
    # Metres from which a thing is not a small one.
    tall: float = 0.12
    # Number of headings tried for a thing that is put down, tipped or dipped.
    headings: int = 8
    # Metres from the middle of a knob to the two points that the fingers hold it at.
    knob_pin_offset: float = 0.015
    # Newtons that a lid is lifted with, so that what it is on neither slides nor tips over.
    lid_force: float = 1.0


class ArticulationParameters(NamedTuple):
    """Doors, drawers, lids, handles, buttons and knobs."""

    # Metres from which a hand goes straight to a handle or a button.
    approach: float = 0.09
    # The part of its way that a finger pushes a button down.
    button_share: float = 0.79
    # Metres from the fingers to the lid between them.
    lid_gap: float = 0.02
    # A button is pressed from this share of its way on.
    pressed_share: float = 0.5
    # Poses of the hand along the way of a door.
    waypoints: int = 8
    # Pushes of a flap, or of a door that is to be shut; the two numbers as for `pulls`.
    pushes: tuple[tuple[float, float], ...] = ((0.5, 1.0), (0.75, 1.0), (0.3, 1.0), (1.0, 1.0), (0.0, 0.5))
    # Goals of opening a door, as shares of its way, best first.
    open_shares: tuple[float, ...] = (1.0, 0.8, 0.65)
    # Shares by which it is moved if it cannot be moved all the way at once.
    partial_shares: tuple[float, ...] = (0.4, 0.25)
    # Pieces that a way is divided into at most.
    stages: int = 4
    # Holds of a handle: share of its way at which the hand is square to it, and how far it keeps its heading.
    pulls: tuple[tuple[float, float], ...] = ((0.0, 1.0), (0.0, 0.5), (0.0, 0.0), (0.5, 1.0), (1.0, 1.0), (0.5, 0.5))
    # The same for a lid: best is a hand that turns with it, for then nothing rubs on what nobody holds.
    lifts: tuple[tuple[float, float], ...] = ((0.0, 0.0), (0.5, 0.3), (0.5, 0.6), (0.0, 1.0), (1.0, 1.0))
    # Metres that a lid may be in a hand on its way.
    lid_penetration: float = 0.004
    # Radians off its front from which a door is opened: it comes towards the robot.
    bearing: float = 0.45
    # A joint is open from this share of its way on.
    open_from: float = 0.6
    # It is shut up to this one; between the two it is neither, and counts as what it was.
    shut_to: float = 0.05
    # A knob is at a setting when it is not farther from it than this share of the way to the next one.
    setting_share: float = 0.25
    # Metres that a hand is drawn back from what it worked, best first.
    retreats: tuple[float, ...] = (0.1, 0.05, 0.025)
    # A door is looked at every so many radians (a drawer: metres).
    sweep_step: float = 0.05
    # Metres that it must stay away: its edge then passes nothing unseen, not even a spoon in the other hand.
    sweep_margin: float = 0.015


class PouringParameters(NamedTuple):
    """Pouring, and dipping a spoon."""

    # Metres between a rim and the mouth that is tipped over it, and from the middle of the rim to below the mouth on
    # the hand's side, best first: under a spout there is little room.
    heights: tuple[tuple[float, float], ...] = ((0.06, 0.0), (0.03, 0.0), (0.06, 0.015), (0.03, 0.02), (0.01, 0.02))
    # Radians by which a thing is tipped, best first.
    tilts: tuple[float, ...] = (1.8, 1.3)
    # Radians by which what hangs from the hand is swung.
    swing: float = 0.5
    # Metres above a rim from which a spoon goes down.
    dip_heights: tuple[float, ...] = (0.05, 0.02)
    # Metres that a spoon goes below a rim.
    dip_depth: float = 0.02
    # Metres below the rim from which it is in.
    dipped_from: float = 0.005
    # Metres from where a spoon pours to the middle of its head.
    head_offset: float = 0.01
    # Radians by which a spoon is dipped with its end down, best first.
    dip_leans: tuple[float, ...] = (0.9, 0.6, 0.3, 1.2, 0.0)
    # Leans above the rim, as shares of the whole one: its end stays over the rim meanwhile.
    level_shares: tuple[float, ...] = (0.0, 0.33, 0.67, 1.0)
    # Metres that a spoon may be in the rim.
    rim_penetration: float = 0.003
    # Tilts of an open thing before a niche, as shares of the whole: a half full one keeps its contents.
    outside_shares: tuple[float, ...] = (0.6, 0.8, 1.0)
    # Radians from which contents run out.
    runs_out_from: float = 1.2
    # Maximum tilt there, as a share of the angle from which it spills.
    outside_margin: float = 0.85
    # Metres from the inside of a wall to the edge that contents leave over.
    wall: float = 0.005
    # Metres from the floor of a basin to its rim.
    basin_depth: float = 0.08
    # Places over a basin that are tried.
    basin_places: int = 3
    # Metres that the mouth may be beside the opening of what it is held over: contents fall straight down.
    mouth_offset: float = 0.004
    # Ways of pouring that are thought through for one stance.
    max_ways: int = 6
    # Pieces that tipping is divided into.
    stages: int = 4


class BaseMotionParameters(NamedTuple):
    """Driving and looking round."""

    # Stances that a base drives to before it gives up.
    max_stances: int = 8
    # Metres that a robot steps back, best first.
    steps_back: tuple[float, ...] = (0.0, 0.1, 0.2, 0.3, 0.45, 0.6)
    # Radians off straight back, best first.
    steps_aside: tuple[float, ...] = (0.0, 0.6, -0.6, 1.2, -1.2)
    # Places to look from that are tried.
    max_lookouts: int = 8
    # Budget of looking for a place to take a thing from: it may be taken from another one later.
    brief_budget: int = 2000
    # Metres round the eye in which there is nothing but the robot.
    head_radius: float = 0.45
    # Metres that the base goes back where the arms have no room to be tucked.
    tuck_steps_back: tuple[float, ...] = (0.12, 0.25, 0.4)
    # Metres between neighbours of the grid.
    grid_pitch: float = 0.1
    # Headings of the grid.
    grid_headings: int = 16
    # Metres that the way keeps from things, where its start and its goal do.
    clearance: float = 0.02
    # Metres: the robot may be this deep in something where it starts (a door that springs open leans on it).
    start_penetration: float = 0.03
    # Strides from the ends of a way within which what touches there may touch.
    near: float = 3.0
    # The part of the clearance that may be lost where corners are rounded.
    rounding: float = 0.5
    # Radians off straight away from what is in the way, best first.
    ways_out: tuple[float, ...] = (0.0, 0.12, -0.12, 0.25, -0.25, 0.4, -0.4, 0.6, -0.6, 0.9, -0.9, 1.3, -1.3)
    # Metres of such a way, best first.
    ways_out_lengths: tuple[float, ...] = (0.6, 0.4, 0.25)
    # Ways out that are tried.
    max_ways_out: int = 3
    # Side, in cells, of the blocks of the grid that are checked at once.
    block: int = 6
    # Searches, each without the moves that turned out to be blocked.
    max_attempts: int = 20
    # Points looked at from the start, to see whether one gets away from there at all.
    escape_points: int = 200
    # Places of the grid, whatever the heading, that are looked at: a room of 80 square metres.
    max_places: int = 8000
    # Metres that turning by one radian costs.
    turn_cost: float = 0.35


class ArmMotionParameters(NamedTuple):
    """Paths of an arm, tucked arms, and carrying."""

    # Metres that planned motions keep from things, where their start and their goal do.
    clearance: float = 0.01
    # Metres: an arm may be this deep in something where it starts (contacts are soft), never deeper on its way.
    start_penetration: float = 0.01
    # Strides from the ends of a way within which what touches there may touch.
    near: float = 2.0
    # The part of the clearance that may be lost where corners are rounded.
    rounding: float = 0.5
    # Postures of a pose that a straight motion is tried with.
    max_branches: int = 12
    # Poses of a straight motion that are solved at once.
    chunk: int = 8
    # The longest edge of the tree, in strides.
    rrt_edge: float = 10.0
    # The same for what is carried upright.
    level_edge: float = 4.0
    # Metres up and towards the robot by which what is carried upright goes out of the way, best first.
    level_detours: tuple[tuple[float, float], ...] = (
        (0.0, 0.0), (0.0, 0.12), (0.08, 0.0), (0.08, 0.15), (0.0, 0.25), (0.2, 0.0), (0.2, 0.2), (0.35, 0.2),
    )  # fmt: skip
    # Metres that it keeps from things there.
    level_clearance: float = 0.004
    # Places to bring it to for which a way is searched at random, where none is straight.
    level_planned: int = 3
    # Radians that what can hold something may lean on its way (10 degrees), or a little more than at its ends.
    level: float = 0.17
    # Samples for a way on which nothing must stay level: most queries that 300 leave open are solved then.
    free_samples: int = 1000
    # Attempts to shorten a path.
    rrt_shortcuts: int = 60
    # Attempts in a row after which a path counts as short.
    rrt_in_vain: int = 12
    # Radians: an arm that is this near to its posture need not move.
    there: float = 0.03
    # If an arm cannot be tucked as usual, one of its first joints is turned by so many radians.
    tuck_shifts: tuple[float, ...] = (-0.1, 0.1, -0.2, 0.2, -0.3, 0.3)
    # Joints of which that is tried.
    max_shifted: int = 6
    # Folded postures tried for each.
    max_folded: int = 2
    # Region of a tool with something in it for driving, in the base's frame: ahead, to its side, up.
    carrying_region: tuple[tuple[float, float], ...] = ((0.3, 0.56), (-0.05, 0.4), (0.9, 1.35))
    # Headings of what is carried that are tried.
    carrying_yaws: int = 8
    # Places tried for what is carried: an arm that gets to none of them is wedged in where it is.
    max_carried: int = 12
    # Samples for the path of an arm that is tucked; a third of it for each place that something held is brought to.
    tuck_samples: int = 300


class InverseKinematicsParameters(NamedTuple):
    """The inverse kinematics of an arm."""

    # Pans of the shoulder that are tried.
    pans: int = 96
    # Starts of the numerical solver.
    starts: int = 64
    # Radians that solutions keep from the limits, where a motor would push against the stop.
    margin: float = 0.01
    # Metres and radians between the pose asked for and the one reached.
    accuracy: tuple[float, ...] = (1e-4, 1e-3)
    # Iterations of the numerical solver.
    rounds: int = 60
    # Of its least squares.
    damping: float = 0.03
    # Radians that a joint moves in one iteration at most.
    stride: float = 0.4
    # Radians that a joint may move between two poses of a motion.
    leap: float = 0.5
    # Radians that it may move without another pan being looked at.
    smooth: float = 0.25


class ContactParameters(NamedTuple):
    """Definition of contact and rest."""

    # Metres: surfaces that are not deeper in each other than this do not collide.
    touch: float = 1e-4
    # Metres that what touched at an end of a way is apart once it has got away from there.
    apart: float = 0.003
    # Metres: what rounding could refuse wrongly.
    slack: float = 0.005
    # Radians: what leans more than this (15 degrees) does not stand.
    upright: float = 0.26
    # Radians from which anything open spills: powder slides from about 35 degrees on, so this is careful.
    repose: float = 0.35
    # Metres: the radius of what runs from a spout.
    stream: float = 0.007
    # Metres and radians within which a thing lies still for a 20th of a second.
    still: tuple[float, float] = (2e-4, 2e-3)
    # Looks, a 20th of a second apart, after which what lay still is at rest.
    settled_after: int = 5
    # Maximum number of looks.
    settle_checks: int = 80


class MotorParameters(NamedTuple):
    """Motors and grippers."""

    # The part of a position error that a motor removes in one step.
    gain: float = 0.2
    # The share of its force that a yielding motor has.
    yielding_share: float = 0.1
    # Steps between two checks of a track.
    check_every: int = 8
    # Steps without getting nearer after which a motion is given up.
    stalled_after: int = 120
    # Metres between the fingers of an open hand.
    gripper_gap: float = 0.09
    # Newtons.
    grip_force: float = 30.0
    # Radians per second.
    finger_speed: float = 0.8
    # Radians that a finger may lag behind before it holds something.
    finger_lag: float = 0.04


# Seconds of computing after which an instruction is given up, by the simulation's count of work: counted, so that a
# slow machine gets the same result.
INSTRUCTION_TIME = 40.0
STANCE = StanceParameters()
GRASP = GraspParameters()
ARTICULATION = ArticulationParameters()
POURING = PouringParameters()
BASE_MOTION = BaseMotionParameters()
ARM_MOTION = ArmMotionParameters()
IK = InverseKinematicsParameters()
CONTACT = ContactParameters()
MOTOR = MotorParameters()
