# SPDX-License-Identifier: Apache-2.0
"""Reads XML of unknown origin into a lossless tree, and writes it.

The tree keeps elements, attributes, text, comments and namespace prefixes. A file with a document type is rejected before it is parsed, so
entities cannot expand. Nothing is loaded from outside.

@satisfies SWR-PFL-001, SWR-PFL-004      Design: docs/design/profiles.md#files
"""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from lxml import etree

from mamori_tools.profiles.schema_table import XSI, SchemaTable
from mamori_trace.base.errors import InputError

MAX_BYTES = 8_000_000
"""Maximum size of a profile. The largest public one is smaller than 1 MB."""
DECLARED = re.compile(rb"""<\?xml[^>]*?\sencoding\s*=\s*["']([A-Za-z][A-Za-z0-9._-]*)["']""")
ODD_ENCODINGS = ("idna", "punycode", "undefined", "unicode_escape", "raw_unicode_escape", "utf_7")
"""Encodings that Python has for other purposes."""
ELEMENTS_MAX = 20_000
"""The largest public profile has 200."""
ATTRIBUTES_MAX = 256
"""Maximum number in one element. libxml2 compares each attribute with all others."""
START_TAG = re.compile(r"<[^/!?\s<]([^<]*+)")
QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'")
PLACE_MAX = 100
"""Maximum length of the name and key of one element in a place."""
MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
DOCUMENT_TYPE = "has a document type, which could define entities; remove the line <!DOCTYPE"
CLARK = re.compile(r"\{([^{}]+)\}")


def read_bytes(path: Path) -> bytes:
    """@raise InputError for a path that is not a readable regular file of at most MAX_BYTES."""
    try:
        if not path.is_file():
            raise InputError("not a regular file; specify a profile" if path.exists() else "not found; check the path", path)
        if path.stat().st_size > MAX_BYTES:
            raise InputError(f"larger than {MAX_BYTES} bytes; specify a profile", path)
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}; check its permissions", path) from error


def parse_xml(data: bytes, path: Path) -> etree._ElementTree:
    """@raise InputError with the line for a document type, a wrong encoding or a syntax error."""
    text = _decode(data, path)
    _reject_document_type(text, path)
    _reject_large_parts(text, path)
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_blank_text=False)
    try:
        tree = etree.ElementTree(etree.fromstring(data, parser))
    except etree.XMLSyntaxError as error:
        reason = re.sub(r", line \d+, column \d+$", "", error.msg or "")
        raise InputError(f"not well-formed XML: {reason}; correct the file or restore it", path, error.lineno or 1) from error
    if tree.docinfo.internalDTD is not None:  # the parser used another encoding than _decode()
        raise InputError(DOCUMENT_TYPE, path, 1)
    return tree


def _decode(data: bytes, path: Path) -> str:
    mark = next((name for mark, name in MARKS if data.startswith(mark)), None)
    declared = DECLARED.match(data.removeprefix(codecs.BOM_UTF8))
    encoding = mark or (declared[1].decode("ascii") if declared else "utf-8")
    try:
        text = "" if codecs.lookup(encoding).name.replace("-", "_") in ODD_ENCODINGS else data.decode(encoding)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(f"byte 0x{data[error.start]:02x} is not valid {encoding}; save the file with its declared encoding", path, line) from error
    except (LookupError, UnicodeError):
        text = ""
    if not text:
        raise InputError(f"unknown encoding {encoding}; save the file as UTF-8", path, 1)
    if "\0" in text or not text.lstrip("\ufeff \t\r\n").startswith("<"):
        raise InputError(f"is not XML text in {encoding}; save the file as UTF-8", path, text.count("\n", 0, max(text.find("\0"), 0)) + 1)
    return text


def _reject_document_type(text: str, path: Path) -> None:
    """Searches up to the start tag of the root element."""
    position = 0
    while (position := text.find("<", position)) >= 0:
        if text.startswith("<!DOCTYPE", position):
            raise InputError(DOCUMENT_TYPE, path, text.count("\n", 0, position) + 1)
        end = "?>" if text.startswith("<?", position) else "-->" if text.startswith("<!--", position) else None
        position = text.find(end, position) if end else -1
        if position < 0:
            return


def _reject_large_parts(text: str, path: Path) -> None:
    """The time of libxml2 is quadratic in these numbers. Tags in comments count as well."""
    for number, match in enumerate(START_TAG.finditer(text), start=1):
        is_large = match[1].count("=") > ATTRIBUTES_MAX and QUOTED.sub("''", match[1]).partition(">")[0].count("''") > ATTRIBUTES_MAX
        if is_large or number > ELEMENTS_MAX:
            what = f"{ATTRIBUTES_MAX} attributes in an element" if is_large else f"{ELEMENTS_MAX} elements"
            raise InputError(f"has more than {what}; specify a profile", path, text.count("\n", 0, match.start()) + 1)


def format_xml(tree: etree._ElementTree) -> bytes:
    """The document with its declaration, encoding and comments; line ends are LF."""
    document = tree.docinfo
    encoding = document.encoding or "UTF-8"
    content = bytes(etree.tostring(tree, xml_declaration=True, encoding=encoding, standalone=document.standalone))
    return content + "\n".encode(encoding).removeprefix(codecs.BOM_UTF16_LE)


def canonicalize(tree: etree._ElementTree) -> bytes:
    """Canonical XML with comments."""
    return bytes(etree.tostring(tree, method="c14n"))


def get_local_name(element: etree._Element) -> str:
    return str(etree.QName(element).localname)


def shorten_names(text: str, table: SchemaTable) -> str:
    """Replaces namespaces in braces by the usual prefixes."""
    prefixes = {XSI: "xsi", **{uri: prefix for prefix, uri in table.namespaces.items()}}
    return CLARK.sub(lambda match: f"{prefixes[match[1]]}:" if match[1] in prefixes else match[0], text)


NAMING = ("name", "instanceName", "id", "connectorId", "groupId", "sequence")
"""Attributes that distinguish elements of one kind, in order of preference."""
SINGLE = ("BasicInfo", "sourceDataPort", "targetDataPort", "sourceServicePort", "targetServicePort", "TargetComponent", "Participant")
"""Elements that occur once and have such an attribute."""


def get_key(element: etree._Element) -> str:
    """The attribute that distinguishes the element from its siblings, as `[value]`; empty if it has none."""
    values = {etree.QName(name).localname: str(value) for name, value in element.attrib.items()}
    name = next((name for name in NAMING if name in values), None)
    return "" if name is None or element.getparent() is None or get_local_name(element) in SINGLE else f"[{values[name]}]"


def describe_path(element: etree._Element, table: SchemaTable) -> str:
    """For example `Components[Std0]/DataPorts[in]`; the root element has its own name."""
    parts = [f"{get_local_name(own)}{get_key(own)}"[:PLACE_MAX] for own in (element, *element.iterancestors()) if isinstance(own.tag, str)]
    return "/".join(reversed(parts[:-1])) or table.shorten(element.tag)
