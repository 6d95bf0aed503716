#!/usr/bin/env bash
# Builds the site target/site/html from docs/ and from what the program writes, and checks its links.
#
#   bash tests/site.sh [--tools]
#
# The builder comes from PyPI, once, into target/site-tools; with --tools nothing else is done. The program
# target/fast/edgeline must be built. Exit code 2 if the builder cannot be had, else that of the step that
# failed.
set -euo pipefail
cd "$(dirname "$0")/.."
tools=target/site-tools
wanted="mkdocs==1.6.1 mkdocs-material==9.8.1 pymdown-extensions==12.3"
if [[ $(cat $tools/made-for 2>/dev/null) != "$wanted" ]]; then
    rm -rf $tools
    /usr/bin/python3 -m venv $tools
    # shellcheck disable=SC2086
    $tools/bin/pip install --quiet --disable-pip-version-check $wanted || {
        echo "error: PyPI cannot be reached or lacks $wanted; make it or a mirror (PIP_INDEX_URL) reachable" >&2
        exit 2
    }
    echo "$wanted" >$tools/made-for
fi

if [[ ${1-} == --tools ]]; then
    exit
fi

docs=target/site/docs
program=$PWD/target/fast/edgeline
rm -rf target/site
mkdir -p $docs
cp -r docs/*.md docs/figures docs/site.css $docs
cp cases/README.md $docs/cases.md
"$program" extras --out target/site/extras >/dev/null
cp target/site/extras/reference.md $docs
# Links of the sources lead to the pages; the reference is there as one.
sed -i -e 's|](\.\./cases/README\.md|](cases.md|g' -e 's|](\.\./docs/|](|g' \
    -e 's|reference (`edgeline extras`)|[reference](reference.md)|g' $docs/*.md
# The pictures of the gallery, by the commands that it names; its own case stands in the first steps.
/usr/bin/python3 - >target/site/docs/my-case.toml <<'PYTHON'
import re
text = open("docs/first-steps.md", encoding="utf-8").read()
print(re.search(r"`my-case.toml`:\n\n```toml\n(.*?)```", text, re.S)[1])
PYTHON
grep '^    edgeline ' docs/gallery.md | while read -r _ arguments; do
    # shellcheck disable=SC2086
    (cd $docs && "$program" $arguments >/dev/null)
done
find $docs/pictures -type f ! -name '*.png' -delete
NO_MKDOCS_2_WARNING=1 $tools/bin/mkdocs build --quiet --strict --config-file docs/mkdocs.yml
# Nothing is fetched from others.
if grep -rlE '(src|href)="https?://[^"]*\.(js|css|woff2?)"' target/site/html --include=*.html; then
    echo "error: these pages fetch files from other hosts" >&2
    exit 1
fi
/usr/bin/python3 tests/links.py target/site/html
echo "target/site/html/index.html"
