#!/usr/bin/python3
"""Turns the bottom of a TELEMAC mesh (Serafin, also called Selafin) into an ESRI ASCII raster.

usage: from_selafin.py MESH.slf OUT.asc [--cell METRES] [--outside ELEVATION]

Between the nodes of the mesh the bottom is linear in each triangle; cells outside the mesh get ELEVATION, or none.
"""

import argparse
import struct
from pathlib import Path

import matplotlib.tri
import numpy


class Records:
    """The records of a big-endian Fortran file one after another."""

    def __init__(self, path):
        self.data, self.at = Path(path).read_bytes(), 0

    def next(self):
        (length,) = struct.unpack_from(">i", self.data, self.at)
        start = self.at + 4
        self.at = start + length + 4
        if self.at > len(self.data) or struct.unpack_from(">i", self.data, self.at - 4) != (length,):
            raise SystemExit("the file is no Serafin file, or is cut off")
        return self.data[start : start + length]

    def integers(self):
        record = self.next()
        return struct.unpack(f">{len(record) // 4}i", record)

    def reals(self, count):
        record = self.next()
        return numpy.frombuffer(record, ">f4" if len(record) == 4 * count else ">f8").astype(float)


def read_bottom(path):
    """x, y, bottom of the nodes [m] and the triangles of a mesh."""
    records = Records(path)
    records.next()  # title
    variables = [records.next()[:16].decode("ascii").strip() for _ in range(sum(records.integers()))]
    if records.integers()[9] == 1:
        records.integers()  # date
    triangle_count, node_count, corners, _ = records.integers()
    if corners != 3:
        raise SystemExit(f"{path}: has elements of {corners} corners, not triangles")
    triangles = numpy.array(records.integers()).reshape(triangle_count, 3) - 1
    records.integers()  # nodes of the boundary
    x, y = records.reals(node_count), records.reals(node_count)
    records.next()  # time
    values = {name: records.reals(node_count) for name in variables}
    for name in ("BOTTOM", "FOND"):
        if name in values:
            return x, y, values[name], triangles
    raise SystemExit(f"{path}: has no bottom, only {', '.join(variables)}")


def raster(x, y, z, triangles, cell):
    """Places of the first cell's centre and values, rows from the north."""
    columns = int(numpy.ceil((x.max() - x.min()) / cell))
    rows = int(numpy.ceil((y.max() - y.min()) / cell))
    at_x = x.min() + cell * (numpy.arange(columns) + 0.5)
    at_y = y.min() + cell * (numpy.arange(rows) + 0.5)
    bottom = matplotlib.tri.LinearTriInterpolator(matplotlib.tri.Triangulation(x, y, triangles), z)
    return bottom(*numpy.meshgrid(at_x, at_y[::-1]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("out")
    parser.add_argument("--cell", type=float, default=10.0, help="size of the cells [m]")
    parser.add_argument("--outside", type=float, default=-9999.0, help="elevation outside the mesh [m]")
    options = parser.parse_args()
    x, y, z, triangles = read_bottom(options.mesh)
    values = numpy.ma.filled(raster(x, y, z, triangles, options.cell), options.outside)
    with open(options.out, "w") as out:
        out.write(f"ncols {values.shape[1]}\nnrows {values.shape[0]}\nxllcorner {x.min():.6f}\n"
                  f"yllcorner {y.min():.6f}\ncellsize {options.cell:g}\nNODATA_value -9999\n")
        numpy.savetxt(out, values, fmt="%.3f")


if __name__ == "__main__":
    main()
