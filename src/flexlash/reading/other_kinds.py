"""Files that are neither workbooks nor tables → what they are and what to do, told by their content."""

from __future__ import annotations

import re
from collections.abc import Collection

from flexlash.reading.refusal import Refusal

__all__ = ["NEITHER", "other_archive", "other_kind"]

NEITHER = "the content is neither a workbook nor a table"

_OLE2 = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_HEAD = 8192
_UNPACK = "unpack it and submit the file inside"
_EXPORT = "save its table as CSV or Parquet"
_ATTACHED = "save the attached file and submit that"
_TARGET = "submit the file that it leads to"
_GOOGLE = "it is a shortcut to a Google file without its cells; in Google Sheets: File, Download, .xlsx"
_PACKED = f"it is a packed file or archive; {_UNPACK}"
_CELLS = "copy its table into the template"

_WORKBOOKS = (
    (
        rb"MIME-Version:.*(?:X-Document-Type: Workbook|office:excel|<x:ExcelWorkbook>)",
        "a web archive (.mht, often named .xls)",
    ),
    (rb"<.*(?:office:excel|<x:ExcelWorkbook>|ProgId content=\"?Excel)", "a web page (.htm, often named .xls)"),
    (rb"<.*progid=\"Excel\.Sheet\"|<(?:.*<)?(?:\w+:)?Workbook\b[^>]*office:spreadsheet", "an XML Spreadsheet 2003"),
    (rb"<.*<office:document\b[^>]*opendocument\.spreadsheet", "a flat OpenDocument file (.fods)"),
    (rb"ID;P\w*(?:;\w+)*\r?\n[A-Z];", "a SYLK file (.slk)"),
    (rb"TABLE\r?\n0,1\r?\n", "a DIF file (.dif)"),
    (rb"\x09[\x00\x02\x04\x08][\x04-\x10]\0", "an old Excel file (.xls)"),
    (rb"\0\0(?:\x02\0[\x04-\x06]\x04|\x1a\0)", "a Lotus 1-2-3 file"),
)
"""What tables of other programs begin with, which Excel opens."""

_OTHERS = (
    (rb"\x89PNG|\xff\xd8\xff|GIF8[79]a|II\*\0|MM\0\*|BM.{4}\0{4}", "it is a picture"),
    (rb"RIFF.{4}WEBP|.{4}ftyp(?:hei|mif|avi)", "it is a picture"),
    (rb"RIFF.{4}(?:WAVE|AVI )|ID3[\2-\4]|.{4}ftyp|OggS|fLaC|\x1aE\xdf\xa3", "it is a sound or film"),
    (rb"%PDF", f"it is a PDF document; {_CELLS}"),
    (rb"\{\\rtf", f"it is a text document (RTF); {_CELLS}"),
    (rb"%!PS", "it is a PostScript document"),
    (rb"version https://git-lfs\.github\.com/", "it is a pointer of Git LFS; get the file itself: git lfs pull"),
    (rb"[./]*(?:git/)?annex/objects/", "it is a pointer of git-annex; get the file itself: git annex get"),
    (rb"\[InternetShortcut|\[\{000214A0", f"it is a shortcut (.url); {_TARGET}"),
    (rb"\[Desktop Entry\]", f"it is a shortcut (.desktop); {_TARGET}"),
    (rb"L\0\0\0\x01\x14\x02\0", f"it is a shortcut of Windows (.lnk); {_TARGET}"),
    (rb"book\0{4}mark", f"it is an alias of macOS; {_TARGET}"),
    (rb"<.*<plist.*<key>URL</key>", f"it is a shortcut (.webloc); {_TARGET}"),
    (rb"bplist0", "it is a shortcut, or a file that iCloud has yet to fetch; open it once"),
    (rb"\{.*(?:\"doc_id\"|\"resource_id\"|docs\.google\.com)", _GOOGLE),
    (rb"\{\s*[\"}]|\[\s*[{\[\"]", f"it is JSON text; {_EXPORT}"),
    (rb"BEGIN:VCARD", "it is an address card (.vcf)"),
    (rb"BEGIN:V", "it is a calendar (.ics)"),
    (rb"%YAML|---[ \t]*\r?\n", f"it is YAML text; {_EXPORT}"),
    (rb"MIME-Version:.*multipart/related", "it is a web archive; open its page and copy the table into the template"),
    (
        rb"(?i)(?:from|to|subject|date|received|return-path|delivered-to|message-id|mime-version|x-[\w-]+|dkim-signature"
        rb"|arc-[\w-]+): .*\n(?:from|to|subject|date|received|message-id|content-type): ",
        f"it is an e-mail; {_ATTACHED}",
    ),
    (rb"<", f"it is a web page or XML text; {_CELLS}"),
    (rb"ISO-10303-21;", "it is a CAD model (STEP)"),
    (rb"AC10[0-9]{2}\0|\s*0\r?\n\s*SECTION\r?\n", "it is a CAD drawing"),
    (rb"SQLite format 3\0", f"it is an SQLite database; {_EXPORT}"),
    (rb"ARROW1\0\0|FEA1\0|\xff{4}.{3}\0", f"it is an Arrow or Feather file; {_EXPORT}"),
    (rb"ORC[^\w ,;|]", f"it is an ORC file; {_EXPORT}"),
    (rb"Obj\x01", f"it is an Avro file; {_EXPORT}"),
    (rb"\x89HDF\r\n", f"it is an HDF5 file; {_EXPORT}"),
    (rb"MATLAB 5\.0", f"it is a MATLAB file; {_EXPORT}"),
    (rb"\x93NUMPY|\x80[\x02-\x05][\x95c}\](]", f"it is an array or object of Python; {_EXPORT}"),
    (rb"RD[XA][23]\n|X\n\0\0\0", f"it is an R data file; {_EXPORT}"),
    (rb"PARE[\0-\x1f]", "it is an encrypted Parquet file; save it without encryption"),
    (rb"\x1f\x8b|BZh[1-9]1AY|\xfd7zXZ|\x28\xb5\x2f\xfd|7z\xbc\xaf|Rar!\x1a|MSCF\0|.{257}ustar", _PACKED),
    (rb"PK\x05\x06", "it is an empty archive"),
    (rb"PK\x07\x08", "it is one part of a split archive; put the parts together and unpack them"),
    (rb"MZ.{0,60}\0|\x7fELF|#!|\xca\xfe\xba\xbe|\xcf\xfa\xed\xfe", "it is a program"),
    (rb"PK[\0-\x1f]", NEITHER),
)  # fmt: skip
"""What files of other kinds begin with; of two patterns that fit the first holds."""

_COMPOUNDS = (
    ("WordDocument", f"it is an old Word document (.doc); {_CELLS}"),
    ("PowerPoint Document", f"it is an old PowerPoint file (.ppt); {_CELLS}"),
    ("__substg1.0_", f"it is an Outlook message (.msg); {_ATTACHED}"),
    ("VisioDocument", "it is a Visio drawing"),
    ("Catalog", "it is a file in which Windows keeps small pictures (Thumbs.db)"),
)
"""Streams by which files in Microsoft's older container are told."""

_PACKAGES = (
    (r"word/document\d*\.xml", f"it is a Word document (.docx); {_CELLS}"),
    (r"ppt/presentation\.xml", f"it is a PowerPoint file (.pptx); {_CELLS}"),
    (r"visio/document\.xml", "it is a Visio drawing"),
    (r"3D/.*\.model", "it is a CAD model (3MF)"),
    (r"FixedDocSeq\.fdseq", f"it is an XPS document; {_CELLS}"),
    (r".+/xl/workbook\.xml", "its parts lie in a folder inside; submit the workbook as Excel saved it"),
    (r"(?:.*/)?[^/]+\.(?:xlsx|xlsm|csv|parquet)", f"it is a zip archive; {_UNPACK}"),
    (r"META-INF/MANIFEST\.MF|AndroidManifest\.xml", "it is a program"),
)


def other_kind(data: bytes) -> Refusal | None:
    """Return the refusal that names a file by its content, None where it may be a table."""
    if data.startswith(_OLE2):
        return _compound(data)
    head = data[:_HEAD]
    if head.startswith((b"\xff\xfe", b"\xfe\xff")):
        head = head.decode("utf-16", "ignore").encode()
    heads = (head, head.removeprefix(b"\xef\xbb\xbf").lstrip(b" \t\r\n"))
    for code, kinds in (("E104", _WORKBOOKS), ("E101", _OTHERS)):
        for pattern, kind in kinds:
            if any(re.match(pattern, head, re.DOTALL) for head in heads):
                return Refusal(code, found=kind)
    return None


def _compound(data: bytes) -> Refusal:
    """Return the refusal of a file in Microsoft's older container."""
    if "EncryptedPackage".encode("utf-16-le") in data:
        return Refusal("E103")
    for stream, kind in _COMPOUNDS:
        if stream.encode("utf-16-le") in data and "Workbook".encode("utf-16-le") not in data:
            return Refusal("E101", found=kind)
    return Refusal("E104", found="an old Excel file (.xls)")


def other_archive(names: Collection[str], mimetype: bytes) -> Refusal | None:
    """Return the refusal that names an archive that is no workbook by its parts; None where it may be one."""
    workbook = {
        "a binary workbook (.xlsb)": "xl/workbook.bin" in names,
        "an OpenDocument file (.ods)": b"spreadsheet" in mimetype
        or ({"content.xml", "META-INF/manifest.xml"} <= set(names) and not mimetype),
        "an Apple Numbers document (in Numbers: File, Export To, Excel)": any(name.endswith(".iwa") for name in names),
    }
    if kind := next((kind for kind, fits in workbook.items() if fits), ""):
        return Refusal("E104", found=kind)
    if mimetype:
        return Refusal("E101", found=f"it is a document of another program; {_CELLS}")
    if "xl/workbook.xml" in names:
        return None
    empty = () if names else ("it is an empty archive",)
    fits = (kind for pattern, kind in _PACKAGES if any(re.fullmatch(pattern, name) for name in names))
    return next((Refusal("E101", found=kind) for kind in (*empty, *fits)), None)
