"""Functions made twice for x86-64: for the vectors all processors have, and for those of 256 bits.

Which one runs is decided by `hb_wide` of the C wrapper, see wide.c. Both give the same bits: what
lies side by side in a vector is never added up.
"""

import re

import llvmlite.binding as llvm

_FLAG = "hb_wide"
_FEATURES = '"target-features"="+avx,-slow-unaligned-mem-32"'


def with_wide(module: llvm.ModuleRef) -> llvm.ModuleRef:
    """A module, not optimised yet, in which what is `hot` is there twice.

    Args:
        module: see `kernels.compiling.jit.hot`.
    """
    twice = [f for f in module.functions if not f.is_declaration and _is_hot(f)]
    if not twice:
        return module
    text, groups = str(module), dict[str, str]()
    for function in twice:
        text = _twice(text, function, groups)
    rows = [f"@{_FLAG} = external hidden global i8", *groups.values()]
    return llvm.parse_assembly("\n".join([text, *rows, ""]))


def _is_hot(function: llvm.ValueRef) -> bool:
    return any(b"hot" in attribute for attribute in function.attributes)


def _twice(text: str, function: llvm.ValueRef, groups: dict[str, str]) -> str:
    """The module's text with a function that chooses between two of it.

    Args:
        text: of the module.
        function: to be made twice.
        groups: lines of attributes of the wide ones, by number; one may be added.
    """
    name = re.escape(function.name)
    head = re.search(rf'^define ([^\n]*)@"?{name}"?(\([^\n]*\))([^\n]*)\{{\n', text, re.MULTILINE)
    assert head
    before, arguments, after = head.groups()
    end = text.index("\n}\n", head.end()) + 1
    body, number = text[head.end() : end], re.findall(r"#(\d+)", after)[0]
    own = re.search(rf"^attributes #{number} = {{(.*)}}$", text, re.MULTILINE)
    assert own
    groups[number] = f"attributes #9{number} = {{{own[1]} {_FEATURES} }}"
    result = before.split()[-1]
    given = ", ".join(f'{a.type} %"{a.name}"' for a in function.arguments)
    ways = "".join(
        f'{way}:\n  %of.{way} = call {result} @"{function.name}.{way}"({given})\n'
        f"  ret {result} %of.{way}\n"
        for way in ("wide", "plain")
    )
    choice = (
        f"  %flag = load i8, ptr @{_FLAG}\n  %is = icmp ne i8 %flag, 0\n"
        f"  br i1 %is, label %wide, label %plain\n{ways}"
    )
    wide = after.replace(f"#{number}", f"#9{number}")
    found = [
        f'define {before}@"{function.name}{way}"{arguments} noinline{attributes}{{\n{lines}}}\n'
        for way, attributes, lines in (
            ("", after, choice),
            (".plain", after, body),
            (".wide", wide, body),
        )
    ]
    return "".join([text[: head.start()], "\n".join(found), text[end + 2 :]])
