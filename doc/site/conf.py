# SPDX-License-Identifier: Apache-2.0
# How Sphinx builds the site. scripts/build_docs lays out its sources, and sets these variables.
import logging
import os
import re
import sys

from breathe.renderer import target
from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util.nodes import make_refnode

sys.path.insert(0, os.environ["HC_PYTHON"])

project = "Hypercolumn"
author = "the Hypercolumn authors"
version = release = os.environ["HC_VERSION"]
root_doc = "index"
language = "en"

extensions = ["breathe", "myst_parser", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
nitpicky = True
# Names of the standard library, Eigen and numpy are nowhere in this site.
nitpick_ignore_regex = [("cpp:.*", ".*"), ("py:.*", ".*")]
suppress_warnings = ["misc.highlighting_failure"]  # placeholders, such as … in a block of C++
smartquotes = False  # -- begins an option
highlight_language = "text"

myst_heading_anchors = 4
myst_enable_extensions = ["html_image"]

breathe_projects = {"hc": os.environ["HC_XML"]}
breathe_default_project = "hc"
breathe_show_include = False
cpp_index_common_prefix = ["hc::"]
cpp_maximum_signature_line_length = python_maximum_signature_line_length = 90

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
python_use_unqualified_type_names = True
add_module_names = False

html_theme = "furo"
html_title = "Hypercolumn " + version
html_static_path = [os.environ["HC_SOURCE"] + "/_static"]
html_css_files = ["site.css"]
html_extra_path = [os.environ["HC_SOURCE"] + "/_extra"]
html_show_copyright = False
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {"navigation_with_keys": True}


def as_restructured(lines):
    """A docstring of ours, text with `code` and indented blocks of code, as reStructuredText."""
    made, is_code = [], False
    for line in lines:
        was_code, is_code = is_code, line.startswith("    ") or (is_code and not line.strip())
        if is_code:
            made += ["", "::", ""] if not was_code and line.strip() else []
            made.append(line)
            continue
        if was_code:
            made.append("")
        parts = line.split("`")
        parts[::2] = [re.sub(r"([*_|\\]|(?<=\w):(?=\w))", r"\\\1", part) for part in parts[::2]]
        made.append("``".join(parts))
    return made


class CppLinks(SphinxPostTransform):
    """Links of the names in declarations: Sphinx's own search takes most of the time of a build."""

    default_priority = 5  # before that search

    def run(self, **_):
        domain = self.env.get_domain("cpp")
        if not hasattr(self.app, "cpp_places"):
            objects = domain.get_objects()
            self.app.cpp_places = {each[0]: (each[3], each[4]) for each in objects}
        for node in list(self.document.findall(pending_xref)):
            if node["refdomain"] != "cpp":
                continue
            scope = node.get("cpp:parent_key")
            names = [str(each[0]) for each in scope.data] if scope else []
            ways = ["::".join([*names[:i], node["reftarget"]]) for i in range(len(names), -1, -1)]
            place = next(
                (self.app.cpp_places[each] for each in ways if each in self.app.cpp_places), None
            )
            shown = nodes.inline("", "", *node.children)
            if place:
                shown = make_refnode(self.app.builder, self.env.docname, *place, node.children)
            node.replace_self(shown)


def is_warning(record):
    """Each header has the namespace hc, which is no duplicate."""
    text = record.getMessage()
    return not ("Duplicate C++ declaration" in text and "'.. cpp:type:: " in text)


def setup(app):
    # Breathe's own anchors would be those of a namespace once for each header; Sphinx has its own.
    target._RealTargetHandler.create_target = lambda self, refid: []
    app.add_post_transform(CppLinks)
    logging.getLogger("sphinx.sphinx.domains.cpp").addFilter(is_warning)
    from pygments.lexers.c_cpp import CLexer

    app.add_lexer("lcm", CLexer)
    app.connect(
        "autodoc-process-docstring",
        lambda app, what, name, each, options, lines: lines.__setitem__(
            slice(None), as_restructured(lines)
        ),
    )
