"""Tagged unions of the scene language: alternatives told apart by the word at the key `kind`."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from operator import or_
from typing import Annotated, Any, TypeVar, get_args

from pydantic import BaseModel, Discriminator, GetCoreSchemaHandler, Tag
from pydantic_core import CoreSchema

from riser_soil.core.quantities import by_kind, tag_of

Model = TypeVar("Model", bound=BaseModel)


def registry(*models: type[Model]) -> dict[str, type[Model]]:
    """Models by their `kind`, a Literal of one word."""
    return {get_args(model.model_fields["kind"].annotation)[0]: model for model in models}


@dataclass(frozen=True, eq=False)
class OneOf:
    """Annotates a key whose value is a mapping read by the model of its kind."""

    models: Mapping[str, type[BaseModel]]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        tagged = tuple(Annotated[model, Tag(tag_of(model))] for model in self.models.values())
        chosen = Discriminator(
            by_kind(dict(self.models)), custom_error_type="kind", custom_error_message=", ".join(self.models)
        )
        return handler.generate_schema(Annotated[reduce(or_, tagged), chosen])

    @property
    def words(self) -> str:
        """The kinds, for a description."""
        return " or ".join(self.models)

    @property
    def examples(self) -> str:
        """A mapping of each kind with the keys that it requires, for a description."""
        return " or ".join(_example(kind, model) for kind, model in self.models.items())


def _example(kind: str, model: type[BaseModel]) -> str:
    required = [name for name, key in model.model_fields.items() if key.is_required() and name != "kind"]
    return f"{{{', '.join([f'kind: {kind}', *(f'{name}: ...' for name in required)])}}}"
