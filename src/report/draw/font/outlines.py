"""Writes letters.txt: widths and outlines of the letters that pictures use, from DejaVu Sans.

    python outlines.py /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf > letters.txt

needs fontTools. A line is a letter, its width and its outline as commands of an SVG path (M, L, Q;
each contour is closed), in thousandths of the letters' size, y upwards from the base line.
"""

import sys

from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont

LETTERS = "".join(map(chr, range(0x20, 0x7F))) + "°±²³µ·×ΔΣΦΨΩαβγδεζηθκλμνξπρστφχψω–—…→∂√∞≈≠≤≥−¹⁴½"


class Outline(BasePen):
    """The commands of a letter's outline; fontTools splits runs of quadratic curves."""

    def __init__(self, glyphs, scale):
        super().__init__(glyphs)
        self.scale, self.commands = scale, []

    def add(self, name, *points):
        self.commands.append(name + " ".join(f"{round(v * self.scale)}" for p in points for v in p))

    def _moveTo(self, point):
        self.add("M", point)

    def _lineTo(self, point):
        self.add("L", point)

    def _qCurveToOne(self, control, point):
        self.add("Q", control, point)

    def _closePath(self):
        pass


def main():
    font = TTFont(sys.argv[1])
    glyphs, names, scale = font.getGlyphSet(), font.getBestCmap(), 1000 / font["head"].unitsPerEm
    for letter in LETTERS:
        glyph = glyphs[names[ord(letter)]]
        outline = Outline(glyphs, scale)
        glyph.draw(outline)
        print(f"{letter} {round(glyph.width * scale)} {' '.join(outline.commands)}".rstrip())


main()
