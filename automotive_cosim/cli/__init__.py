"""The command line, one file per command."""

RUN, READ, CONTENTS, TOOLS = "Run agents", "Read, check and publish results", "Tasks and places", "Tools"
"""Parts of the list of commands."""
