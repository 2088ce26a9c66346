"""JSON Schemas of types, for editors and for the words of our own error messages.

The dialect is draft 7, which editors know best. Local times have a pattern, as ``format`` asks for an offset.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from pydantic import TypeAdapter, with_config
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from automotive_cosim.contracts import Json
from automotive_cosim.formats.docs import inherited_field_docs, prose


@cache
def adapter(kind: type) -> TypeAdapter[Any]:
    """The reader of a type: nothing is coerced, extra fields are refused, numbers are finite."""
    return TypeAdapter(with_config({"strict": True, "extra": "forbid", "allow_inf_nan": False})(kind))


@cache
def json_schema(kind: type) -> Json:
    """The schema of a type's values, for the words of an error message."""
    return adapter(kind).json_schema(schema_generator=_Draft7)


def documented(kind: type, *, null: bool = False) -> Json:
    """The schema with descriptions from the docstrings of classes and fields; requires the source code.

    Args:
        null: whether an absent value may also be written as ``null``, which TOML does not have."""
    made: Json = adapter(kind).json_schema(schema_generator=_Documented if null else _WithoutNull)
    return made


class _Draft7(GenerateJsonSchema):
    schema_dialect = "http://json-schema.org/draft-07/schema#"

    def field_title_should_be_set(self, schema: Any) -> bool:
        """Never: it would be the field's name once more."""
        return False

    def tuple_schema(self, schema: core_schema.TupleSchema) -> JsonSchemaValue:
        """A list of fixed length has its items under ``items``; ``prefixItems`` is of a later draft."""
        made = super().tuple_schema(schema)
        if "prefixItems" in made:
            made["items"] = made.pop("prefixItems")
        return made

    def tagged_union_schema(self, schema: core_schema.TaggedUnionSchema) -> JsonSchemaValue:
        """``discriminator`` is OpenAPI's; ``oneOf`` says it."""
        made = super().tagged_union_schema(schema)
        made.pop("discriminator", None)
        return made

    def dataclass_schema(self, schema: core_schema.DataclassSchema) -> JsonSchemaValue:
        """What tells the members of a union apart has a default for programs, and must stand in a file."""
        made = super().dataclass_schema(schema)
        for name, field in made.get("properties", {}).items():
            if "const" in field and field.get("default") == field["const"]:
                del field["default"]
                made["required"] = [name, *made.get("required", [])]
        return made


class _Documented(_Draft7):
    def dataclass_schema(self, schema: core_schema.DataclassSchema) -> JsonSchemaValue:
        made = super().dataclass_schema(schema)
        made["description"] = prose(made.get("description", ""))
        for name, text in inherited_field_docs(schema["cls"]).items():
            if name in made["properties"]:
                made["properties"][name]["description"] = text
        return made


class _WithoutNull(_Documented):
    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        made = super().default_schema(schema)
        return {name: value for name, value in made.items() if name != "default" or value is not None}
