# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""YAML in the style of rosbag2."""

from typing import Any

import yaml

# Ten times as fast, where PyYAML was built with libyaml.
_DUMPER = getattr(yaml, 'CSafeDumper', yaml.SafeDumper)


def yaml_text(content: Any) -> str:
    """Return ``content`` as block YAML, its keys in the order given."""
    return yaml.dump(content, Dumper=_DUMPER, sort_keys=False, default_flow_style=False).strip()
