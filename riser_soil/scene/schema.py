"""JSON schema of the scene language, for editors."""

import json

from riser_soil.scene.scene import Scene


def schema_text() -> str:
    """The schema of a scene file; every key with its description, unit, bounds and default."""
    dialect = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return json.dumps(dialect | Scene.model_json_schema(by_alias=True), indent=2)
