"""Build native FMUs into the cache of generated artefacts."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from herringbone.components.registry import COMPONENTS
from herringbone.core import FmuError, ParameterError
from herringbone.core.caching.built import note_built
from herringbone.core.caching.files import all_stored, alone_in, is_stored, store, store_all
from herringbone.core.caching.keys import digest_of, kernels_key, wrapper_key
from herringbone.core.places.paths import cache_folder
from herringbone.core.places.temporary import temporary_folder
from herringbone.core.process.activity import activity
from herringbone.fmi.archive import add_to_archive
from herringbone.fmi.native.carried import carried_fmu
from herringbone.fmi.native.compiler import compile_library, compile_wrapper, require_compiler
from herringbone.fmi.native.component_source import component_source
from herringbone.fmi.native.model import Model, registered_model
from herringbone.fmi.native.objects import object_code
from herringbone.fmi.native.pack import pack_native
from herringbone.fmi.native.platforms import Platform, own_platform, platform_of
from herringbone.fmi.native.symbols import check_library, check_object
from herringbone.fmi.reference import reference_files

VERSIONS = (2, 3)
"""FMI versions that native FMUs are built for."""


def build_native_fmus(
    names: Iterable[str] | None = None,
    *,
    platforms: Sequence[str] = (),
    fmi: int = 2,
    files: Mapping[str, Path] | None = None,
) -> dict[str, Path]:
    """Build native FMUs of components, or take those that these sources gave before.

    Args:
        names: components; all if not given.
        platforms: names of platforms; this process' own one if not given.
        fmi: FMI version, 2 or 3.
        files: resource files that the FMUs carry instead of those that come along, by
            `component.parameter`.

    Returns:
        Path of the FMU by component.

    Raises:
        StructureError, ParameterError: there is no such component, platform, FMI version or file.
        ResourceError: a resource file is missing or malformed.
        FmuError: there is no compiler, it failed, or a binary would need more than libc.
    """
    names = list(COMPONENTS if names is None else names)
    given: dict[str, dict[str, Path]] = {}
    for path, file in (files or {}).items():
        owner, _, parameter = path.partition(".")
        given.setdefault(owner, {})[parameter] = file
    if others := sorted(given.keys() - set(names)):
        raise ParameterError(f"a file is given for {others[0]}, which is not built")
    models = [registered_model(name, given.get(name)) for name in names]
    return build_models(models, platforms=platforms, fmi=fmi)


def build_models(
    models: Sequence[Model], *, platforms: Sequence[str] = (), fmi: int = 2
) -> dict[str, Path]:
    """As `build_native_fmus`, for any models."""
    if fmi not in VERSIONS:
        raise ParameterError(f"FMI version {fmi}; it must be 2 or 3")
    chosen = _chosen(platforms)
    carried = {model.name: carried_fmu(model, chosen, fmi) for model in models}
    fmus = {
        model.name: carried[model.name]
        or cache_folder("native-fmus")
        / f"{model.name}-{model.key}"
        / f"fmi{fmi}-{'+'.join(p.name for p in chosen)}"
        / f"{model.name}.fmu"
        for model in models
    }
    missing = [
        model for model in models if not carried[model.name] and not is_stored(fmus[model.name])
    ]
    for model in missing:
        what = f"building the native FMU of {model.name}"
        with activity(what, "only when its code has changed"), alone_in(_folder_of_kernels(model)):
            if is_stored(fmus[model.name]):  # another process was building it
                continue
            content = _built(model, chosen, fmi)
            note_built(content)
            store(fmus[model.name], content)
    return fmus


def _built(model: Model, platforms: list[Platform], fmi: int) -> bytes:
    """The FMU of a model for platforms."""
    _make_libraries(model, platforms, fmi)
    with temporary_folder() as scratch:
        libraries = {platform: _library(model, platform, fmi) for platform in platforms}
        packed = pack_native(model, libraries, fmi, scratch / f"{model.name}.fmu")
        if model.shipped or own_platform() in platforms:
            add_to_archive(packed, reference_files(packed, shipped=model.shipped))
        return packed.read_bytes()


def _library(model: Model, platform: Platform, fmi: int) -> Path:
    """Where the library of a model for an FMI version lies in the cache."""
    compiler = require_compiler(platform)
    folder = cache_folder("native-libraries") / f"{model.name}-{model.library_key}"
    return (
        folder / f"{platform.name}-{compiler.name}-fmi{fmi}" / f"{model.name}.{platform.extension}"
    )


def _chosen(platforms: Sequence[str]) -> list[Platform]:
    """The platforms, each once."""
    if platforms:
        return sorted({platform_of(name) for name in platforms}, key=lambda p: p.name)
    own = own_platform()
    if own is None:
        raise FmuError("native FMUs are not built for this platform; use Python FMUs")
    return [own]


def _folder_of_kernels(model: Model) -> Path:
    """Where the object code of a model's kernels lies in the cache; FMI versions share it."""
    return cache_folder("native-objects") / f"{model.kernels_name}-{model.kernels_key}"


def _kernels(model: Model, platform: Platform) -> Path:
    """The object code of a model's kernels for a platform."""
    return _folder_of_kernels(model) / f"{platform.name}.o"


def _make_kernels(model: Model, platforms: list[Platform]) -> None:
    """Make the object code that is not in the cache."""
    missing = [p for p in platforms if not is_stored(_kernels(model, p))]
    if not missing:
        return
    for platform, code in object_code(model.component, missing).items():
        check_object(code, platform, model.name)
        store(_kernels(model, platform), code)


def _wrapper(platform: Platform, fmi: int) -> list[Path]:
    """Object files of the wrapper, from the cache if they are there."""
    compiler = require_compiler(platform)
    key = digest_of(wrapper_key(), kernels_key(compile_wrapper.__module__))
    folder = cache_folder("native-objects") / f"wrapper-{key}"
    folder = folder / f"{platform.name}-{compiler.name}-fmi{fmi}"
    with alone_in(folder):
        if files := all_stored(folder):
            return files
        with temporary_folder() as scratch:
            compile_wrapper(compiler, platform, scratch, fmi)
            store_all(folder, {file.name: file.read_bytes() for file in scratch.glob("*.o")})
        return all_stored(folder)


def _make_libraries(model: Model, platforms: list[Platform], fmi: int) -> None:
    """Make the libraries that are not in the cache."""
    missing = [p for p in platforms if not is_stored(_library(model, p, fmi))]
    if not missing:
        return
    _make_kernels(model, missing)
    with temporary_folder() as scratch:
        description = scratch / f"{model.name}.c"
        description.write_text(component_source(model.states), encoding="ascii")
        for platform in missing:
            target, compiler = _library(model, platform, fmi), require_compiler(platform)
            library = scratch / target.name
            objects = [*_wrapper(platform, fmi), _kernels(model, platform)]
            compile_library(compiler, platform, description, objects, library)
            code = library.read_bytes()
            check_library(code, platform, model.name)
            store(target, code)
