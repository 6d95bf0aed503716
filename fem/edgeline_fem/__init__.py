"""Finite-element reference solutions of finite contact lines.

A roller is pressed on a block; both have free end faces. This package meshes a quarter of each body,
or half of it where both ends are not alike, with the gmsh program, solves the frictionless contact with FEniCSx and samples stresses and contact
pressure at the requested points. It reads JSON and writes CSV and JSON.

Conventions used everywhere in the package:

* Units. Lengths are in units of the Hertz half-width C and stresses in units of the Hertz pressure p0
  unless a name ends in ``_m``, ``_pa`` or ``_n``.
* Axes. x is across the contact, y runs along the contact line from its middle, z points into the body
  at hand. Each body has its own z; x and y are shared. What is modelled is x >= 0, and of a symmetric scene y >= 0.
* Signs. Stress is positive in tension; contact pressure and contact forces are positive in compression.
"""
