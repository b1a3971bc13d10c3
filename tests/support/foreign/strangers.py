"""Systems of foreign FMUs."""


def write_system(folder, name, connections, files):
    """A system of FMUs."""
    path = folder / name
    path.mkdir(exist_ok=True)
    parts = [f'{part} = {{ fmu = "{file}" }}' for part, file in files.items()]
    lines = [f'name = "{name}"', f"connections = {connections}", "[parts]", *parts]
    (path / "system.toml").write_text("\n".join(lines), encoding="utf-8")
    return path
