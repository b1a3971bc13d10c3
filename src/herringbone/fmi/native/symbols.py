"""What a binary asks of the system: the gate that keeps Python, libm and young systems out.

Formats: System V ABI (ELF), gABI symbol versioning; Microsoft PE/COFF specification; Apple Mach-O
(mach-o/loader.h, mach-o/nlist.h). Only the 64-bit little-endian forms that are built here.
"""

import struct
from collections.abc import Iterator
from typing import Final

from herringbone.core import FmuError
from herringbone.fmi.native.platforms import Platform

_IN_OBJECTS: Final = frozenset({
    "__bzero", "bzero", "memcpy", "memmove", "memset", "memset_pattern16",
})  # fmt: skip
"""What object code of kernels may ask for: copying and filling; compilers put these calls in."""
_OF_WRAPPER: Final = frozenset({"hb_wide"})
_LIBC: Final = _IN_OBJECTS | {
    "bcmp", "calloc", "fclose", "ferror", "fgetc", "fopen", "fread", "free",
    "freelocale", "fseek", "ftell", "localeconv", "malloc", "memchr", "memcmp", "newlocale",
    "realloc", "snprintf", "stpcpy", "strcat", "strchr", "strcmp", "strcpy", "strcspn", "strlen",
    "strncmp", "strncpy", "strpbrk", "strspn", "strstr", "strtod", "strtod_l", "vsnprintf",
}  # fmt: skip
_RUNTIME: Final = frozenset({
    "__cxa_finalize", "__gmon_start__", "_ITM_deregisterTMCloneTable",
    "_ITM_registerTMCloneTable", "dyld_stub_binder",
})  # fmt: skip
_WINDOWS_LIBRARIES: Final = ("kernel32.dll", "api-ms-win-crt-")
_NEWEST_GLIBC: Final = (2, 17)


def check_object(data: bytes, platform: Platform, what: str) -> None:
    """Check that object code of kernels needs nothing but copying and filling of memory.

    Raises:
        FmuError: it needs more.
    """
    _refuse(sorted(undefined(data) - _IN_OBJECTS - _OF_WRAPPER), platform, f"the kernels of {what}")


def check_library(data: bytes, platform: Platform, what: str) -> None:
    """Check that a library needs nothing but some functions of libc, of an old system.

    Raises:
        FmuError: it needs more, or a younger system.
    """
    if platform.extension == "dll":
        libraries = {name.lower() for name in _pe_imports(data)}
        bad = sorted(n for n in libraries if not n.startswith(_WINDOWS_LIBRARIES))
    else:
        bad = sorted(undefined(data) - _LIBC - _RUNTIME)
    _refuse(bad, platform, f"the library of {what}")
    if platform.extension == "so":
        young = [v for v in glibc_versions(data) if v > _NEWEST_GLIBC]
        names = [f"GLIBC_{'.'.join(map(str, v))}" for v in young]
        _refuse(names, platform, f"the library of {what}")


def _refuse(symbols: list[str], platform: Platform, what: str) -> None:
    if symbols:
        raise FmuError(
            f"{what} for {platform.name} would need {', '.join(symbols)} at run time; refused"
        )


def undefined(data: bytes) -> set[str]:
    """Names that an object file, or an ELF or Mach-O library, leaves to others."""
    if data[:4] == b"\x7fELF":
        return set(_elf_undefined(data))
    if data[:4] == b"\xcf\xfa\xed\xfe":
        return set(_macho_undefined(data))
    return set(_coff_undefined(data))


def _name(data: bytes, at: int) -> str:
    return data[at : data.index(b"\0", at)].decode()


def _elf_sections(data: bytes) -> list[tuple[int, ...]]:
    """Type, offset, size, link of each section."""
    (table,) = struct.unpack_from("<Q", data, 40)
    width, count = struct.unpack_from("<HH", data, 58)
    headers = [struct.unpack_from("<IIQQQQIIQQ", data, table + i * width) for i in range(count)]
    return [(h[1], h[4], h[5], h[6]) for h in headers]


def _elf_undefined(data: bytes) -> Iterator[str]:
    symbol_table, dynamic_table = 2, 11
    sections = _elf_sections(data)
    kinds = {kind for kind, *_ in sections}
    wanted = dynamic_table if dynamic_table in kinds else symbol_table
    for kind, offset, size, link in sections:
        if kind == wanted:
            for at in range(offset + 24, offset + size, 24):
                name, _, _, section = struct.unpack_from("<IBBH", data, at)
                if section == 0:
                    yield _name(data, sections[link][1] + name)


def glibc_versions(data: bytes) -> set[tuple[int, ...]]:
    """Versions of glibc that an ELF library asks for."""
    needed = 0x6FFFFFFE
    sections = _elf_sections(data)
    found = set()
    for kind, offset, _, link in sections:
        at = offset if kind == needed else 0
        while at:
            _, count, _, aux, following = struct.unpack_from("<HHIII", data, at)
            aux += at
            for _ in range(count):
                _, _, _, name, skip = struct.unpack_from("<IHHII", data, aux)
                text = _name(data, sections[link][1] + name)
                if text.startswith("GLIBC_"):
                    found.add(tuple(int(n) for n in text[6:].split(".")))
                aux += skip
            at = at + following if following else 0
    return found


def _coff_undefined(data: bytes) -> Iterator[str]:
    external = 2
    symbols, count = struct.unpack_from("<II", data, 8)
    strings = symbols + 18 * count
    i = 0
    while i < count:
        at = symbols + 18 * i
        value, section, _, storage, further = struct.unpack_from("<IhHBB", data, at + 8)
        if section == 0 and value == 0 and storage == external:
            zeros, offset = struct.unpack_from("<II", data, at)
            short = data[at : at + 8].rstrip(b"\0").decode() if zeros else ""
            yield short or _name(data, strings + offset)
        i += 1 + further


def _macho_undefined(data: bytes) -> Iterator[str]:
    symbol_command, external, type_mask = 2, 0x01, 0x0E
    (commands,) = struct.unpack_from("<I", data, 16)
    at = 32
    for _ in range(commands):
        command, size = struct.unpack_from("<II", data, at)
        if command == symbol_command:
            symbols, count, strings, _ = struct.unpack_from("<IIII", data, at + 8)
            for i in range(count):
                name, kind = struct.unpack_from("<IB", data, symbols + 16 * i)
                if kind & external and not kind & type_mask:
                    yield _name(data, strings + name).removeprefix("_")
        at += size


def _pe_imports(data: bytes) -> Iterator[str]:
    """Names of the libraries that a DLL imports from."""
    (header,) = struct.unpack_from("<I", data, 0x3C)
    (count,) = struct.unpack_from("<H", data, header + 6)
    (optional,) = struct.unpack_from("<H", data, header + 20)
    (imports,) = struct.unpack_from("<I", data, header + 24 + 112 + 8)
    first = header + 24 + optional
    sections = [struct.unpack_from("<IIII", data, first + 40 * i + 8) for i in range(count)]

    def offset(address: int) -> int:
        for _, start, size, raw in sections:
            if start <= address < start + size:
                return address - start + raw
        raise FmuError(f"address {address:#x} lies in no section of the library")

    at = offset(imports)
    while name := struct.unpack_from("<I", data, at + 12)[0]:
        yield _name(data, offset(name))
        at += 20
