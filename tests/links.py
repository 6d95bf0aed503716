"""Checks the links of a site: every file that a page names is there, and every place within it.

    python3 tests/links.py FOLDER

Prints what is missing and ends with exit code 1 if anything is. Links to other hosts are not followed.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The links of a page and the places that links may name."""

    def __init__(self, path: Path):
        super().__init__()
        self.links, self.places = [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.links.append(value)
            if name in ("id", "name") and value:
                self.places.add(value)


def main(folder: Path) -> int:
    pages = {path.resolve(): Page(path) for path in folder.rglob("*.html")}
    missing = []
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or path.name == "404.html":
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            there = target.exists()
            place = unquote(parts.fragment)
            if there and place and target in pages:
                there = place in pages[target].places
            if not there:
                missing.append(f"{path.name}: {link}")
    print("\n".join(missing) or f"all links of {len(pages)} pages lead somewhere")
    return 1 if missing or not pages else 0


sys.exit(main(Path(sys.argv[1])))
