# SPDX-License-Identifier: Apache-2.0
"""Order of the component folders of kernel and safety as data, and the check of that order.

@satisfies SWR-PRF-042      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

# Folder -> level. A file may include its own folder and folders of lower levels.
FOLDER_LEVELS: Mapping[str, Mapping[str, int]] = {
    "kernel": {"base": 0, "component": 1, "payload": 1, "record": 1, "dataflow": 2, "parameter": 2, "c": 3, "table": 3, "run": 4, "system": 4},
    "safety": {"base": 0, "arm": 1, "redundancy": 1, "supervision": 1, "e2e": 1, "notice": 2, "reaction": 2, "self_test": 2, "assumptions": 3, "cycle": 4},
}
UMBRELLA_HEADERS = ("kernel/include/mamori/kernel.hpp",)


def find_folder(path: tuple[str, ...]) -> str | None:
    """@return the component folder of a header or source of kernel or safety; "" if it is outside component folders; None for other
    files."""
    match path:
        case (layer, "include", "mamori", _, *inner) | (layer, "src", *inner) if layer in FOLDER_LEVELS:
            if "/".join(path) in UMBRELLA_HEADERS:
                return None
            return inner[0] if len(inner) > 1 and inner[0] in FOLDER_LEVELS[layer] else ""
        case _:
            return None


def check_place(path: tuple[str, ...]) -> Iterator[str]:
    """@return a message for a header or source outside the component folders."""
    if find_folder(path) == "":
        yield f"{path[0]} has component folders only ({', '.join(FOLDER_LEVELS[path[0]])}); move the file into one of them"


def check_order(path: tuple[str, ...], include: str) -> Iterator[str]:
    """@param include path of a project header, as in the include line. @return a message if the order of the folders forbids the
    include."""
    match include.split("/"):
        case ["mamori", layer, folder, *inner] if inner and layer in FOLDER_LEVELS:
            pass
        case _:
            return
    levels, own = FOLDER_LEVELS[layer], find_folder(path)
    is_same_layer = path[0] == layer
    if inner[0] == "detail" and not (is_same_layer and ("tests" in path or own == folder)):
        yield f"'{include}' is a detail of {layer}/{folder}; include a public header of that folder"
    elif own and is_same_layer and folder != own and levels.get(folder, 0) >= levels[own]:
        yield f"{layer}/{own} (level {levels[own]}) may not include '{include}' (level {levels.get(folder, 0)}); only lower levels"
