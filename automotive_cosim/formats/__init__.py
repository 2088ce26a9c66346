"""Files that users write: read strictly, refused with one line per problem, described to editors by JSON Schemas.

    TOML, JSON -> checked against the annotations of a dataclass -> its instance, or a UserError

annotations  annotations of fields: names, forms, conversions
checked      values -> an instance, or the problems in words
toml         a file, and the lines of its entries
words        what came and what was expected, from a JSON Schema
schema       the JSON Schema of a type
scenario     the form of a ``scenario.toml``, with the incidents that it may stage
"""
