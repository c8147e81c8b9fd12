#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The documentation as a static site that opens without a network or a server: pandoc, one template, no other tools.

    build_site.py FOLDER

Pages keep their places (docs/users/first-steps.html), README.md becomes index.html. docs/README.md gives navigation and
reading order. Files that pages link to are copied. A link into nothing, or a warning of pandoc, ends it with exit code 1.
"""
import html
import json
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
LINK = re.compile(r'((?:href|src)=")([^"]+)(")')


def sources() -> list[Path]:
    return sorted([*(ROOT / "docs").rglob("*.md"), *(p for p in ROOT.glob("*.md"))])


def address(page: Path) -> Path:
    """Where a page stands in the site."""
    path = page.relative_to(ROOT)
    return path.with_name("index.html") if path.name == "README.md" else path.with_suffix(".html")


def navigation() -> list[tuple[str, list[tuple[str, Path]]]]:
    """Groups of (title, page) in the order of docs/README.md."""
    index = ROOT / "docs/README.md"
    groups: list[tuple[str, list[tuple[str, Path]]]] = [("kinfer", [("Overview", ROOT / "README.md"), ("All pages", index)])]
    seen = {ROOT / "README.md", index}
    for line in index.read_text().splitlines():
        if heading := re.match(r"## (.*)|\*\*(.*)\*\*$", line):
            groups.append((heading[1] or heading[2], []))
        for title, target in re.findall(r"\[([^\]]+)\]\(([^)#]+\.md)", line):
            page = (index.parent / target).resolve()
            if page not in seen:
                groups[-1][1].append((title[0].upper() + title[1:], page))
                seen.add(page)
    return [(name, pages) for name, pages in groups if pages]


def relative(target: Path, page: Path) -> str:
    return os.path.relpath(address(target), address(page).parent)


def side(groups: list[tuple[str, list[tuple[str, Path]]]], page: Path) -> str:
    parts = []
    for name, pages in groups:
        parts.append(f"<h2>{html.escape(name)}</h2><ul>")
        for title, target in pages:
            here = ' class="here" aria-current="page"' if target == page else ""
            parts.append(f'<li><a{here} href="{relative(target, page)}">{html.escape(title)}</a></li>')
        parts.append("</ul>")
    return "".join(parts)


def neighbours(order: list[tuple[str, Path]], page: Path) -> str:
    at = next((i for i, (_, target) in enumerate(order) if target == page), None)
    if at is None:
        return ""
    links = [(f"← {order[at - 1][0]}", order[at - 1][1])] if at > 0 else []
    links += [(f"{order[at + 1][0]} →", order[at + 1][1])] if at + 1 < len(order) else []
    return "".join(f'<a href="{relative(target, page)}">{html.escape(title)}</a>' for title, target in links)


def rewritten(match: re.Match[str], page: Path, linked: set[Path]) -> str:
    """A link to a page leads to its place in the site; other files are noted, to be copied."""
    target, _, anchor = match[2].partition("#")
    if re.match(r"[a-z]+:", target) or not target:
        return match[0]
    path = (page.parent / target).resolve()
    if path.suffix == ".md":
        target = os.path.relpath(address(path), address(page).parent)
    elif path.is_file():
        linked.add(path)
    elif path.is_dir():  # its files come with it
        linked.update(p for p in path.rglob("*") if p.is_file())
    return f"{match[1]}{target}{'#' + anchor if anchor else ''}{match[3]}"


def text_of(body: str) -> str:
    return re.sub(r"\s+", " ", html.unescape(re.sub(r"<[^>]+>", " ", body))).strip()


def broken_links(folder: Path) -> list[str]:
    found = []
    anchors: dict[Path, set[str]] = {}
    for page in sorted(folder.rglob("*.html")):
        for link in re.findall(r'(?:href|src)="([^"]+)"', page.read_text()):
            target, _, anchor = link.partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            path = (page.parent / target).resolve() if target else page
            if not path.exists():
                found.append(f"{page.relative_to(folder)}: {link} leads nowhere")
            elif anchor and path.suffix == ".html":
                if path not in anchors:
                    anchors[path] = set(re.findall(r'id="([^"]+)"', path.read_text()))
                if html.unescape(anchor) not in anchors[path]:
                    found.append(f"{page.relative_to(folder)}: no heading {link}")
    return found


def main() -> int:
    folder = Path(sys.argv[1]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    template = (HERE / "page.html").read_text()
    groups = navigation()
    order = [entry for _, pages in groups for entry in pages]
    linked: set[Path] = set()

    def convert(page: Path) -> tuple[Path, str, str]:
        run = subprocess.run(["pandoc", "--from", "gfm", "--to", "html5", "--wrap", "none", "--fail-if-warnings", page],
                             capture_output=True, text=True)
        return page, run.stdout, run.stderr

    warnings, index = [], []
    with ThreadPoolExecutor(2) as workers:
        for page, body, warning in workers.map(convert, sources()):
            warnings += [f"{page.relative_to(ROOT)}: {line}" for line in warning.splitlines()]
            body = LINK.sub(lambda match: rewritten(match, page, linked), body)
            body = re.sub(r"<!--.*?-->", "", body, flags=re.S).replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")
            heading = re.search(r"<h1[^>]*>(.*?)</h1>", body, flags=re.S)
            title = text_of(heading[1]) if heading else page.stem
            root = os.path.relpath(".", address(page).parent)
            values = {"title": html.escape(title), "side": side(groups, page), "body": body, "root": root,
                      "neighbours": neighbours(order, page)}
            place = folder / address(page)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(re.sub(r"\{\{(\w+)\}\}", lambda match: values[match[1]], template))
            index.append({"title": title, "url": str(address(page)), "text": text_of(body)})
    for path in linked:
        place = folder / path.relative_to(ROOT)
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, place)
    (folder / "search_index.js").write_text("const pages = " + json.dumps(index, ensure_ascii=False) + ";\n")
    for name in ("site.css", "search.js"):
        shutil.copyfile(HERE / name, folder / name)
    problems = warnings + broken_links(folder)
    print("\n".join(problems) if problems else f"{len(index)} pages in {folder}")
    return 1 if problems else 0


sys.exit(main())
