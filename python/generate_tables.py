"""Writes sprag/_tables: the tables of a scene as frozen values, from scenes/scene.schema.json. Run it after a key has changed."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from textwrap import fill
from typing import Any

Schema = dict[str, Any]

SCHEMA = Path(__file__).parent / "../scenes/scene.schema.json"
OUT = Path(__file__).parent / "sprag" / "_tables"

HEAD = '''"""{title} as frozen values. Made by generate_tables.py from the schema of scenes: do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from .._table import Table
'''

# What motions of a kind have, as `sprag_sim::scene::ground` refuses the others.
AMPLITUDE = ["amplitude_ratio", "amplitude_g", "amplitude_m_s2"]
FREQUENCY = ["frequency_ratio", "frequency_hz"]
PULSE = AMPLITUDE + FREQUENCY
MOTIONS = {
    "Sine": ("sine", PULSE),
    "Cosine": ("cosine", PULSE),
    "HalfSine": ("half-sine", PULSE),
    "Rectangular": ("rectangular", [*AMPLITUDE, "duration_s", "duration_ratio"]),
    "Ricker": ("ricker", PULSE),
    "MavroeidisPapageorgiou": (
        "mavroeidis-papageorgiou",
        ["velocity_amplitude_m_s", *FREQUENCY, "oscillations", "phase_deg"],
    ),
}
DEVICES = {"NoDevice": "none", "Inerter": "inerter", "ClutchedPair": "clutched-pair"}


def alternatives(schema: Schema) -> list[Schema]:
    return schema.get("anyOf") or schema.get("oneOf") or [schema]


def words(schema: Schema) -> list[str]:
    """The words that a key takes."""
    found = []
    for choice in alternatives(schema):
        found += [choice["const"]] if "const" in choice else choice.get("enum", [])
        if choice is not schema and "oneOf" in choice:
            found += words(choice)
    return found


def type_of(schema: Schema, tables: dict[str, str], key: str) -> str:
    if key in tables:
        name = tables[key]
        if schema.get("type") == "array":
            return f"Sequence[{name}]"
        texts = any(choice.get("type") == "string" for choice in alternatives(schema))
        return f"{name} | str" if texts else name
    known = words(schema)
    simple = {"number": "float", "integer": "int", "boolean": "bool", "string": "str"}
    types = [simple[choice["type"]] for choice in alternatives(schema) if choice.get("type") in simple]
    types = [name for name in dict.fromkeys(types) if not (name == "str" and known)]
    if known:
        types.append(f"Literal[{', '.join(json.dumps(word) for word in known)}]")
    return " | ".join(types)


def bounds(schema: Schema) -> str:
    numbers = [choice for choice in alternatives(schema) if choice.get("type") in ("number", "integer")]
    if not numbers:
        return ""
    number = numbers[0]
    low = [f"{text} {number[name]:g}" for name, text in [("minimum", "from"), ("exclusiveMinimum", "above")] if name in number]
    high = [f"{text} {number[name]:g}" for name, text in [("maximum", "to"), ("exclusiveMaximum", "below")] if name in number]
    if low and high and not (high[0].startswith("to") and low[0].startswith("from")):
        low[0] += " and" if high[0].startswith("below") else ","
    return " ".join(low + high)


def sentence(key: str, schema: Schema) -> str:
    text = schema.get("description", "").replace("`", "").rstrip(".")
    extent = bounds(schema)
    default = schema.get("default")
    if extent:
        text += f"; {extent}"
    if default is not None and not isinstance(default, (dict, list)):
        text += f"; {default if isinstance(default, str) else json.dumps(default)} by default"
    return text + "."


def table(
    name: str,
    schema: Schema,
    path: str,
    *,
    summary: str = "",
    fixed: dict[str, str] | None = None,
    keys: list[str] | None = None,
    tables: dict[str, str] | None = None,
) -> str:
    fixed, tables = fixed or {}, tables or {}
    properties = {key: value for key, value in schema["properties"].items() if key not in fixed and (keys is None or key in keys)}
    required = [key for key in schema.get("required", []) if key in properties]
    order = required + [key for key in properties if key not in required]
    lines = ["", "", "@dataclass(frozen=True, kw_only=True, repr=False)", f"class {name}(Table):"]
    summary = (summary or schema["description"]).replace("`", "")
    if order:
        lines += [f'    """{summary}', "", "    Attributes", "    ----------"]
        for key in order:
            lines.append(f"    {key}")
            text = sentence(key, properties[key])
            lines.append(fill(text, 110, initial_indent=" " * 8, subsequent_indent=" " * 8))
        lines += ["", "    Raises", "    ------", "    InputError"]
        lines += ["        For a value outside its range.", '    """', ""]
    else:
        lines += [f'    """{summary}"""', ""]
    lines.append(f'    _path: ClassVar[str] = "{path}"')
    if fixed:
        lines.append(f"    _fixed: ClassVar[dict[str, str]] = {json.dumps(fixed)}")
    if order:
        lines.append("")
    for key in order:
        kind = type_of(properties[key], tables, key)
        line = f"    {key}: {kind}" if key in required else f"    {key}: {kind} | None = None"
        lines.append(line if len(line) <= 140 else f"    {key}: (\n        {kind}\n        | None\n    ) = None")
    return "\n".join(lines)


def described(schema: Schema, word: str) -> str:
    return next(choice["description"] for choice in schema["oneOf"] if choice["const"] == word)


def sources() -> dict[str, str]:
    """The files, by name."""
    scene = json.loads(SCHEMA.read_text(encoding="utf-8"))["properties"]
    device, ground = scene["device"]["items"], scene["ground"]["items"]
    controller = scene["controller"]["properties"]
    sensors = controller["sensors"]["properties"]
    inner = {
        "flywheels": "Flywheel",
        "flywheel": "FlywheelLosses",
        "clutch": "Clutch",
        "rack": "Rack",
        "actuation": "Actuation",
        "weight": "Weight",
        "support_record": "SupportRecord",
    }
    foundation = table("Foundation", scene["block"]["properties"]["foundation"], "block.foundation")
    structure = [foundation, table("Block", scene["block"], "block", tables={"foundation": "Foundation"})]
    for key, name in inner.items():
        listed = key == "flywheels"
        schema = device["properties"][key]
        structure.append(table(name, schema["items"] if listed else schema, f"device.{key}" + ".0" * listed))
    for name, kind in DEVICES.items():
        summary = described(device["properties"]["kind"], kind)
        keys = ["name"] if kind == "none" else None
        structure.append(table(name, device, "device", summary=summary, fixed={"kind": kind}, keys=keys, tables=inner))
    motions = []
    for name, (kind, keys) in MOTIONS.items():
        summary = described(ground["properties"]["motion"], kind)
        motions.append(table(name, ground, "ground", summary=summary, fixed={"motion": kind}, keys=[*keys, "scale", "start_s"]))
    following = [
        table("Duration", scene["run"], "run"),
        table("Accuracy", scene["accuracy"], "accuracy"),
        table("Gear", scene["checks"]["properties"]["gear"], "checks.gear"),
        table("Coil", scene["checks"]["properties"]["coil"], "checks.coil"),
        table("Checks", scene["checks"], "checks", tables={"gear": "Gear", "coil": "Coil"}),
        table("Output", scene["output"], "output", summary="What is kept of a run.", keys=["interval_s", "energy"]),
    ]
    own = [("gyroscope", "Gyroscope"), ("block_accelerometer", "Accelerometer"), ("encoder", "Encoder")]
    kinds = {**dict(own), "ground_accelerometer": "Accelerometer"}
    control = [table("Belief", controller["belief"], "controller.belief")]
    for key, name in own:
        schema = next(choice for choice in sensors[key]["anyOf"] if "properties" in choice)
        control.append(table(name, schema, f"controller.sensors.{key}", summary=f"{name} with keys of its own."))
    control.append(table("Sensors", controller["sensors"], "controller.sensors", tables=kinds))
    inside = {"belief": "Belief", "sensors": "Sensors"}
    control.append(table("Controller", scene["controller"], "controller", summary="Controller of the clutches.", tables=inside))
    return {
        "structure.py": file("Blocks and devices", structure, f"\n\nDevice = {' | '.join(DEVICES)}\n"),
        "motion.py": file("Ground motions", motions, f"\n\nMotion = {' | '.join(MOTIONS)}\n"),
        "following.py": file("How a motion is followed", following),
        "control.py": file("Controllers and their sensors", control),
    }


def file(title: str, tables: list[str], end: str = "") -> str:
    text = HEAD.replace("{title}", title) + "\n".join(tables) + "\n" + end
    if "Sequence[" not in text:
        text = text.replace("from collections.abc import Sequence\n", "")
    return text if "Literal[" in text else text.replace(", Literal", "")


def main() -> None:
    for name, text in sources().items():
        if "--check" not in sys.argv[1:]:
            (OUT / name).write_text(text, encoding="utf-8")
        elif (OUT / name).read_text(encoding="utf-8") != text:
            sys.exit(f"{name} is not what the schema says: run {__file__}")


if __name__ == "__main__":
    main()
