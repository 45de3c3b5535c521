"""Print the JSON schema of the configuration: `python -m neural_shadows.config`."""

import json

from neural_shadows.config.whole import Config


def json_schema() -> str:
    """The JSON schema of the configuration, as checked in under workflow/schemas."""
    return json.dumps(Config.model_json_schema(), indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    print(json_schema(), end="")
