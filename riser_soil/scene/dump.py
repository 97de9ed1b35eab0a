"""The resolved scene as YAML, all defaults filled in, and the JSON schema of the scene language."""

import io
import json
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.nodes import Node
from ruamel.yaml.representer import SafeRepresenter

from riser_soil.scene.scene import Scene


def dump_scene(scene: Scene) -> str:
    """The scene as YAML text; null stands for a part or value that is absent."""
    return yaml_text(scene.model_dump(mode="json", by_alias=True))


def yaml_text(data: dict[str, Any]) -> str:
    """A scene's plain data as YAML text."""
    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style = None  # vectors and small mappings on one line
    yaml.sort_base_mapping_type_on_output = False  # keep the language's own order
    yaml.width = 110
    yaml.representer.yaml_representers = {**yaml.representer.yaml_representers, float: _float}
    stream = io.StringIO()
    yaml.dump(data, stream)
    return stream.getvalue()


def _float(representer: SafeRepresenter, value: float) -> Node:
    """A float with a point and a signed exponent, which YAML 1.1 readers take for a number as well."""
    text = repr(value)
    if "e" in text and "." not in text:
        text = text.replace("e", ".0e")
    return representer.represent_scalar("tag:yaml.org,2002:float", text)


def schema_text() -> str:
    """The schema of a scene file; every key with its description, unit, bounds and default."""
    dialect = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return json.dumps(dialect | Scene.model_json_schema(by_alias=True), indent=2)
