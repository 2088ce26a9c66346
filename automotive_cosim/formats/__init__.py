"""What users write: read strictly, refused in one line for each problem, described to editors as JSON Schema.

    TOML, JSON -> checked against the annotations of a dataclass -> its instance, or a UserError

annotations  what an annotation says of a field: names, forms, what is made of it
checked      values -> an instance, or the problems in words
files        the text of a file
toml         a TOML file, and in which line of it things stand
words        what came and what was expected, from a JSON Schema
schema       the JSON Schema of a type
"""
