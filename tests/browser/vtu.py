"""fields.vtu, read by the library of ParaView."""

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def read(path):
    """The grid in the file."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    return reader.GetOutput()


def cells(grid, name):
    """A scalar on the cells, as a list."""
    array = grid.GetCellData().GetArray(name)
    return [array.GetValue(k) for k in range(array.GetNumberOfTuples())]


def of_triangle(grid, name, triangle):
    """The value of a scalar on a triangle of the mesh."""
    return cells(grid, name)[cells(grid, "triangle").index(triangle)]
