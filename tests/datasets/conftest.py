"""The data set, if the user has it, and a small one of our own in the same format."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tmd.datasets.veil500 import VeilData, load

OBJECTS = """<objects>
 <object><name>Mug</name><name>Kettle</name>
  <attributes><property>
   <state><stateName>Color</stateName><default>Null</default></state>
   <state><stateName>Water</stateName><default>False</default></state>
   <state><stateName>Coffee</stateName><default>False</default></state>
   <state><stateName>IceCream</stateName><default>False</default></state>
   <state><stateName>Chocolate</stateName><default>False</default></state>
   <state><stateName>Vanilla</stateName><default>False</default></state>
   <state><stateName>Salt</stateName><default>False</default></state>
  </property>
  <affordances><affordance>IsGraspable</affordance><affordance>IsPourable</affordance></affordances></attributes>
 </object>
 <object><name>Kettle</name><attributes><property>
   <stateName>Ramen</stateName><default>False</default></property></attributes></object>
 <object><name>Kettle</name>
   <state><stateName>Water</stateName><default>True</default></state></object>
 <object><name>Ramen</name><name>Salt</name><name>BoiledEgg</name><name>Fork</name><name>GarbageBag</name>
   <name>Tv_1Remote</name><name>Book</name>
   <affordances><affordance>IsGraspable</affordance></affordances></object>
 <object><name>Syrup</name><attributes><property>
   <state><stateName>Vanilla</stateName><default>False</default></state>
   <state><stateName>Chocolate</stateName><default>False</default></state></property>
  <affordances><affordance>IsGraspable</affordance><affordance>IsSqueezeable</affordance></affordances></attributes>
 </object>
 <object><name>IceCream</name><attributes><property>
   <state><stateName>ScoopsLeft</stateName><default>True</default></state></property>
  <affordances><affordance>IsGraspable</affordance></affordances></attributes></object>
 <object><name>Spoon</name><attributes><property>
   <state><stateName>ScoopsLeft</stateName><default>False</default></state></property>
  <affordances><affordance>IsGraspable</affordance></affordances></attributes></object>
 <object><name>Plate</name><attributes><property>
   <state><stateName>Egg</stateName><default>False</default></state>
   <state><stateName>Ramen</stateName><default>False</default></state>
   <state><stateName>Spoon</stateName><default>False</default></state>
   <state><stateName>Fork</stateName><default>False</default></state></property>
  <affordances><affordance>IsGraspable</affordance></affordances></attributes></object>
 <object><name>Fridge</name><attributes><property>
   <state><stateName>LeftDoorIsOpen</stateName><default>False</default></state>
   <state><stateName>RightDoorIsOpen</stateName><default>False</default></state>
   <state><stateName>WaterDispenserIsOpen</stateName><default>False</default></state></property></attributes></object>
 <object><name>Stove</name><attributes><property>
   <state><stateName>StoveFire1</stateName><default>False</default></state>
   <state><stateName>StoveFire2</stateName><default>False</default></state></property></attributes></object>
 <object><name>Microwave</name><attributes><property>
   <state><stateName>DoorIsOpen</stateName><default>False</default></state>
   <state><stateName>MicrowaveIsOn</stateName><default>False</default></state></property></attributes></object>
 <object><name>SinkKnob</name>
   <state><stateName>TapIsOn</stateName><default>False</default></state></object>
 <object><name>Tv</name><attributes><property>
   <state><stateName>IsOn</stateName><default>False</default></state>
   <state><stateName>Channel1</stateName><default>False</default></state>
   <state><stateName>Channel2</stateName><default>False</default></state>
   <state><stateName>Channel3</stateName><default>False</default></state>
   <state><stateName>Channel4</stateName><default>False</default></state>
   <state><stateName>Channel5</stateName><default>False</default></state>
   <state><stateName>Channel6</stateName><default>False</default></state>
   <state><stateName>Volume</stateName><default>False</default></state></property></attributes></object>
 <object><name>BagOfChips</name><state><stateName>HasChips</stateName><default>True</default></state>
   <state><stateName>IsOpen</stateName><default>False</default></state>
   <affordances><affordance>IsGraspable</affordance></affordances></object>
 <object><name>Cd</name><state><stateName>CD</stateName><default>True</default></state>
   <affordances><affordance>IsGraspable</affordance></affordances></object>
 <object><name>Xbox</name><state><stateName>CD</stateName><default>False</default></state>
   <affordances><affordance>IsGraspable</affordance></affordances></object>
 <object><name>Counter</name><name>Sink</name><name>StoveFire</name><name>CoffeeTable</name><name>Loveseat</name>
   <affordances><affordance>IsPlaceableOn</affordance></affordances></object>
 <object><name>Fridge</name><name>Microwave</name><name>GarbageBag</name>
   <affordances><affordance>IsPlaceableIn</affordance></affordances></object>
</objects>
"""

KITCHEN = {
    "Counter_1": (0, 40, 0),
    "Sink": (60, 43, 0),
    "SinkKnob": None,
    "Stove": (-60, 34, 0),
    "StoveKnob_1": None,
    "StoveKnob_2": None,
    "StoveFire_1": (-65, 46, 0),
    "StoveFire_2": (-50, 46, 0),
    "Microwave": (90, 52, -40),
    "MicrowaveDoor": (90, 52, -30),
    "MicrowaveButton": None,
    "Fridge": (0, 40, 90),
    "FridgeLeftDoor": (-12, 40, 70),
    "FridgeRightDoor": (12, 40, 70),
    "FridgeButton": None,
    "Mug_1": (5, 50, 2),
    "Kettle": (-64, 48, 3),
    "Ramen_1": (10, 50, 5),
    "Salt_1": (12, 50, 5),
    "BoiledEgg_1": (3, 45, 88),
    "IceCream_1": (-4, 45, 92),
    "Spoon_1": (15, 50, 5),
    "Fork_1": (16, 50, 5),
    "IceCreamScoop": None,
    "Syrup_1": (20, 50, 5),
    "Syrup_2": (22, 50, 5),
    "Plate_1": (90, 50, -31),
    "GarbageBag_1": (30, 0, 60),
    "Robinia_7": (0, 0, 0),
}
LIVING_ROOM = {
    "coffeeTable_1": (0, -21, 20),
    "loveseat_1": (0, -13, 70),
    "tv_1": (-48, 3, -90),
    "tv_1Remote_1": (5, -12, 22),
    "bagOfChips_1": (-15, -12, 22),
    "book_1": (100, -28, 100),
    "xbox_1": (-50, -27, -45),
    "cd_1": (3, -12, 18),
    "garbageBag_1": (60, -20, 40),
    **{f"Tv_1{k}Button": None for k in ("Power", "ChannelUp", "ChannelDown", "VolumeUp", "VolumeDown")},
    **{f"Tv_1Remote_1{k}Button": None for k in ("Power", "ChannelUp", "ChannelDown", "VolumeUp", "VolumeDown", "Mute")},
}
STATES = {
    "Mug_1": {"Filled": "True", "Water": "1"},
    "tv_1": {"IsOn": "False", "Channel3": "True", "Volume": "20"},
}

DATA = """<root>
<point>
<text>Boil   water  | in the pot |  . Rinse the plate now rinse the plate now |
 . Stop .</text>
<environment>kitchen_scenario_environment_number_2</environment>
<objective> Making Ramen</objective>
<action_sequence>
<action>moveto Kettle</action>
<change_of_alignment/>
<change_of_alignment/>
<action>keep Kettle On Sink</action>
</action_sequence>
</point>
<point>
<text>Turn the set on .</text>
<environment>living_room_scenario_environment_number9</environment>
<objective>Prepare Room for Movie Night</objective>
<action_sequence>
<action>moveto Tv_1</action>
<action>press Tv_1PowerButton</action>
<action>dance Unicorn_1</action>
</action_sequence>
</point>
</root>
"""


def environment_xml(objects: dict[str, tuple[int, int, int] | None]) -> str:
    """An environment file."""
    lines = ["<environment>"]
    for name, position in objects.items():
        where = f"({', '.join(map(str, position))})" if position else "-200,-200,-200"
        states = "".join(
            f"<state><statename>{s}</statename><statevalue>{v}</statevalue></state>"
            for s, v in STATES.get(name, {}).items()
        )
        lines.append(
            f"<object><name>{name}</name><position>{where}</position><rotation>(0, 90, 0)</rotation>{states}</object>"
        )
    return "\n".join([*lines, "</environment>", ""])


def write_small(root: Path) -> Path:
    """A data set of our own, in the format of the released one."""
    for folder, number, objects in (("kitchen", 2, KITCHEN), ("livingRoom", 1, LIVING_ROOM)):
        path = root / "Environments" / folder
        path.mkdir(parents=True)
        (path / f"{folder}{number}.xml").write_text(environment_xml(objects))
    (root / "Objects.xml").write_text(OBJECTS)
    (root / "data.xml").write_text(DATA)
    return root


@pytest.fixture
def small_directory(tmp_path: Path) -> Path:
    return write_small(tmp_path)


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory) -> VeilData:
    return load(write_small(tmp_path_factory.mktemp("veil")))


@pytest.fixture(scope="session")
def veil() -> VeilData:
    directory = os.environ.get("VEIL500_DIR")
    if not directory:
        pytest.skip("VEIL500_DIR does not name a copy of VEIL-500")
    return load(directory)


@pytest.fixture(scope="session")
def released(veil: VeilData) -> VeilData:
    """The copy, if it is the training part whose numbers are known."""
    if len(veil.points) != 360:
        pytest.skip(f"the numbers are those of 360 points, this copy has {len(veil.points)}")
    return veil
