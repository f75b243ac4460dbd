"""Which keys of JSON files, and columns of CSV files, have other places than in the stored set: keys.toml."""

import fnmatch
import re
import tomllib

PLACE = re.compile(r"\[\]|\*\*|\*")
MATCHING = {"[]": r"\[(\d+)\]", "**": r"(.*)", "*": r"([^.\[]+)"}


class KeyMapping:
    """The mapping of all files."""

    def __init__(self, path):
        content = tomllib.loads(path.read_text())
        self.new_files = content.get("new_files", [])
        self.kinds = content.get("kind", [])

    def is_new_file(self, name):
        return is_named(name.rpartition("/")[2], self.new_files)

    def of(self, name):
        """The mapping of one file by its name, or of what a command printed; None where nothing is mapped."""
        chosen = [kind for kind in self.kinds if is_named(name, kind["files"]) and not is_named(name, kind.get("except", []))]
        return FileMapping(chosen) if chosen else None


class FileMapping:
    """The rules for one file. Paths: `sensors[].axes[].drift.sd`; a rule holds for what is below its path too."""

    def __init__(self, kinds):
        together = {name: [entry for kind in kinds for entry in kind.get(name, [])] for name in ("dropped", "added", "changed")}
        self.dropped, self.added, self.changed = ([matcher(path) for path in paths] for paths in together.values())
        self.moved = [(matcher(old), new) for kind in kinds for old, new in kind.get("moved", {}).items()]

    def differences(self, old, new):
        """Sentences. Objects are lists of pairs, as scripts/golden parses them. A null may be left out."""
        old = {self.new_path(path): value for path, value in leaves("", old) if not is_any(self.dropped, path)}
        new = dict(leaves("", new))
        for path, value in old.items():
            if path not in new:
                if value is not None:
                    yield f"{path} is gone"
            elif (type(value), value) != (type(new[path]), new[path]) and not is_any(self.changed, path):
                yield f"{path}: {value} before, {new[path]} now"
        for path, value in new.items():
            if path not in old and not is_any(self.added, path):
                yield f"{path} is new: {value}"

    def new_path(self, path):
        for pattern, new in self.moved:
            if found := pattern.match(path):
                caught = iter(found.groups())
                return PLACE.sub(lambda place: f"[{next(caught)}]" if place[0] == "[]" else next(caught), new) + path[found.end() :]
        return path


def is_named(name, patterns):
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def matcher(path):
    """Of a path and of all that is below it."""
    written, end = "", 0
    for place in PLACE.finditer(path):
        written += re.escape(path[end : place.start()]) + MATCHING[place[0]]
        end = place.end()
    return re.compile(written + re.escape(path[end:]) + r"(?=[.\[]|$)")


def is_any(patterns, path):
    return any(pattern.match(path) for pattern in patterns)


def leaves(path, value):
    """Pairs of a path and its scalar. What is empty counts as one."""
    if isinstance(value, tuple) and value[1]:
        for key, entry in value[1]:
            yield from leaves(f"{path}.{key}" if path else key, entry)
    elif isinstance(value, list) and value:
        for place, entry in enumerate(value):
            yield from leaves(f"{path}[{place}]", entry)
    else:
        yield path, value
