"""Reads every kind of file that runs leave with the programs that people read them with, and compares them."""

import json
import sys
import warnings
from pathlib import Path

import csvw
import meshio
import numpy as np
import pandas as pd
import pyvista as pv
import vtk
from vtk.numpy_interface import dataset_adapter

warnings.filterwarnings("ignore", message=".*OVITO.*PyPI")
from ovito.io import import_file  # noqa: E402

out = Path(sys.argv[1])
STANDARD = ["Particle Identifier", "Particle Type", "Radius", "Position", "Velocity", "Angular Velocity", "Force"]


def last(run, kind):
    """The last file of this kind, and its time."""
    reader = pv.get_reader(str(out / run / f"{kind}.pvd"))
    reader.set_active_time_value(reader.time_values[-1])
    return reader.read()[0], reader.time_values[-1]


def ovito_reads_the_grains_as_vtk_does(run):
    points, time = last(run, "grains")
    pipeline = import_file(str(out / run / "grains.pvd"))
    assert pipeline.num_frames == len(pv.get_reader(str(out / run / "grains.pvd")).time_values)
    data = pipeline.compute(pipeline.num_frames - 1)
    assert data.attributes["Time"] == time
    assert points.field_data["TimeValue"][0] == time
    arrays = ["id", "shapetype", "radius", None, "v", "omega", "f"]
    particles = data.particles
    for name, array in zip(STANDARD, arrays):
        own = points.points if array is None else points[array]
        assert np.array_equal(np.asarray(particles[name], dtype=own.dtype), own), name
    # Whether OVITO knows what they are, and does not just carry them along.
    for standard in [particles.velocities, particles.forces, particles.identifiers, particles.particle_types]:
        assert standard is not None
    assert len(particles.particle_types.types) == len(set(points["shapetype"]))
    assert "Velocity Magnitude" in particles, "computed of what is known to be a velocity"
    assert points.n_verts == points.n_points == particles.count
    assert np.array_equal(particles["coordination"], points["coordination"])
    return points, particles


def bytes_a_grain(run, points, most):
    files = sorted((out / run / "grains").iterdir())
    size = files[-1].stat().st_size / points.n_points
    print(f"{run}: {size:.1f} B a grain and output")
    assert size < most


def spheres():
    for run in ["drum", "wet"]:
        points, particles = ovito_reads_the_grains_as_vtk_does(run)
        # The file's head, shared by a hundred grains, is 20 of them.
        bytes_a_grain(run, points, 120)
        assert ("film" in points.array_names) == (run == "wet")
        if run == "wet":
            assert np.allclose(particles["film"], points["film"]) and points["film"].sum() > 0


def contacts():
    for run in ["drum", "wet", "column"]:
        points, _ = last(run, "grains")
        lines, _ = last(run, "contacts")
        assert lines.n_lines == lines.n_cells > 0
        first, second = np.asarray(lines["id1"]), np.asarray(lines["id2"])
        force = np.asarray(lines["force_normal"], float) + np.asarray(lines["force_tangential"])
        sums = np.zeros((points.n_points, 3))
        np.add.at(sums, first, force)
        grains = second >= 0
        np.add.at(sums, second[grains], -force[grains])
        scale = np.abs(force).max()
        assert np.allclose(sums, points["f"], atol=1e-5 * scale), run
        network = import_file(str(out / run / "contacts.pvd"))
        network = network.compute(network.num_frames - 1).lines["particle-particle-contacts"]
        assert network.count == 2 * lines.n_cells
        assert np.array_equal(network["Particle Identifier 2"][::2], second)
        mesh = import_file(str(out / run / "container.vtp")).compute().surfaces["mesh"]
        assert mesh.faces.count == pv.read(out / run / "container.vtp").n_cells > 0


def polyhedra():
    points, particles = ovito_reads_the_grains_as_vtk_does("column")
    bytes_a_grain("column", points, 10e6 / 68722 + 10)
    axes = np.asarray(points["tensor"], float).reshape(-1, 3, 3)
    x, y, z, w = np.asarray(particles.orientations, float).T
    # The first body axis as the quaternion turns it.
    turned = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=1)
    assert np.allclose(turned, axes[:, 0], atol=1e-5)
    shapes = pv.read(out / "column" / "shapes.vtu")
    assert shapes.n_cells == points.n_points
    assert np.array_equal(np.unique(shapes.point_data["id"]), np.arange(shapes.n_cells))
    owner = shapes.point_data["id"]
    placed = points.points[owner] + np.einsum("nk,nki->ni", shapes.points, axes[owner])
    # The farthest point of a rounded grain is its radius away, the corner of its solid a little more.
    far = np.zeros(points.n_points)
    np.maximum.at(far, owner, np.linalg.norm(shapes.points, axis=1))
    ratio = far / points["radius"]
    assert np.all(ratio > 1) and np.median(ratio) < 1.3
    assert np.allclose(filtered_as_in_paraview(shapes, points), placed, atol=1e-8)
    assert len(meshio.read(out / "column" / "shapes.vtu").points) == shapes.n_points


def filtered_as_in_paraview(shapes, grains):
    """What the Programmable Filter of docs/analysis.md makes of the two."""
    document = (Path(__file__).parents[2] / "docs" / "analysis.md").read_text(encoding="utf-8")
    script = document.split("```text\n")[1].split("```")[0]
    output = vtk.vtkUnstructuredGrid()
    output.CopyStructure(shapes)
    scope = {
        "inputs": [dataset_adapter.WrapDataObject(part) for part in [shapes, grains]],
        "output": dataset_adapter.WrapDataObject(output),
    }
    exec(script, scope)
    wrapped = pv.wrap(output)
    assert np.array_equal(wrapped.cell_data["v"], grains["v"])
    return wrapped.points


def tables():
    for run, names in [("drum", {"series.csv", "flow.csv", "velocity.csv"}), ("column", {"series.csv", "profile.csv"})]:
        check_tables(out / run, names)
    cases = check_tables(out / "sweep", {"table.csv"})["table.csv"]
    assert list(cases["drum-speed [rad/s]"].round(6)) == [0.314159, 0.628319]
    assert set(cases["ended"]) == {"done"} and set(cases["state"].str.len()) == {32}
    record = json.loads((out / "sweep" / "sweep.json").read_text())
    assert list(cases["state"]) == [case["state_hash"] for case in record["cases"]]


def check_tables(folder, names):
    metadata = csvw.CSVW(str(folder / "csv-metadata.json"), validate=True)
    assert metadata.is_valid, metadata.warnings
    # Whether anything happened in so short a run is not what is tested here.
    assert {table.url.string for table in metadata.tables} - {"events.csv"} == names
    read = {}
    for table in metadata.tables:
        frame = read[table.url.string] = pd.read_csv(folder / table.url.string)
        columns = table.tableSchema.columns
        assert [str(column.titles) for column in columns] == list(frame.columns)
        for column in columns:
            is_number = column.datatype.base in ["double", "integer"]
            assert is_number == ("schema:unitText" in column.common_props), column.titles
            cells = frame[str(column.titles)].dropna()
            assert cells.empty or is_number == pd.api.types.is_numeric_dtype(cells), column.titles
    return read


for check in [spheres, contacts, polyhedra, tables]:
    check()
    print(f"{check.__name__}: read")
