"""The site: guides, Python, notebooks, examples and notes. `scripts/docs` builds it."""

import re

import calibrant

project = "calibrant"
author = "the authors of calibrant"
version = release = calibrant.__version__
language = "en"

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "myst_nb",
]
html_theme = "furo"
html_title = f"calibrant {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
pygments_dark_style = "github-dark"
html_show_copyright = False
html_show_sphinx = False
html_copy_source = False

# as on GitHub: headings are link targets
myst_heading_anchors = 4
myst_links_external_new_tab = False

# the outputs are those of the code that the site documents, whole reports too; the repository has them without
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_timeout = 300
nb_execution_raise_on_error = True

autodoc_member_order = "bysource"
# numpydoc's sections have types and defaults
autodoc_typehints = "none"
autodoc_preserve_defaults = True
autosummary_generate = False
numpydoc_show_class_members = False

# links to a folder of the examples, as on GitHub
_FOLDER = re.compile(r"\]\(((?:\.\./)*(?:examples/|(?=\d\d_)))(\w+)?/?\)")
_NOTES = "\n```{toctree}\n:hidden:\n:glob:\n\n20*\n```\n"


def _for_the_site(_app, name, source):
    """What the pages on GitHub do not need."""
    source[0] = _FOLDER.sub(lambda found: f"]({found[1]}{found[2]}/README.md)" if found[2] else f"]({found[1]}index.md)", source[0])
    if name == "docs/notes/README":
        source[0] += _NOTES


def _all_documented(app, failure):
    """Every public name has its place in the reference."""
    if failure is not None:
        return
    documented = {name for name, *_ in app.env.get_domain("py").get_objects()}
    public = {f"calibrant.{name}" for name in calibrant.__all__ if name != "fleet"}
    public |= {f"calibrant.fleet.{name}" for name in calibrant.fleet.__all__}
    if missing := sorted(public - documented):
        raise RuntimeError(f"the reference lacks {', '.join(missing)}")


def setup(app):
    app.connect("source-read", _for_the_site)
    app.connect("build-finished", _all_documented)
