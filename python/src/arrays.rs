//! Between NumPy and this program. What an object keeps as rows of numbers is seen in place: the array is read-only and keeps its
//! object alive.

use numpy::ndarray::{Array2, ArrayView1, ArrayView2};
use numpy::{
    Element, IntoPyArray, PyArray1, PyArray2, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray2, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;

use crate::errors::{fault, raised};
use hypercircle::cli::Exit;

/// n numbers of an object.
pub fn numbers<'py, O, T>(owner: &Bound<'py, O>, of: impl FnOnce(&O) -> &[T]) -> PyResult<Bound<'py, PyArray1<T>>>
where
    O: PyClass<Frozen = True> + Sync,
    T: Element,
{
    let view = ArrayView1::from(of(owner.get()));
    // SAFETY: the numbers are borrowed from the object, which is frozen: they stay where they are until it goes, and the array
    // holds it. Nobody writes them, because the array is not writeable.
    let array = unsafe { PyArray1::borrow_from_array(&view, owner.clone().into_any()) };
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}

/// n × N numbers of an object.
pub fn rows<'py, O, T, const N: usize>(
    owner: &Bound<'py, O>,
    of: impl FnOnce(&O) -> &[[T; N]],
) -> PyResult<Bound<'py, PyAny>>
where
    O: PyClass<Frozen = True> + Sync,
    T: Element,
{
    let flat = numbers(owner, |object| of(object).as_flattened())?;
    flat.call_method1("reshape", ((flat.len() / N, N),))
}

/// Indices, as NumPy has them.
pub fn signed<'py>(indices: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    indices.call_method1("view", ("intp",))
}

/// n × N numbers that were made for the array.
pub fn made<const N: usize>(py: Python<'_>, rows: Vec<[f64; N]>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let shape = (rows.len(), N);
    let rows = Array2::from_shape_vec(shape, rows.into_flattened()).map_err(fault)?;
    Ok(rows.into_pyarray(py))
}

/// Rows of an argument, copied, with whether they were in single precision.
///
/// # Errors
/// `InputError` where `object` is no table of numbers.
pub fn table(what: &str, object: &Bound<'_, PyAny>) -> PyResult<(Vec<Vec<f64>>, bool)> {
    let array = two_dimensional(what, object, b"fiu", "numbers")?;
    let single = array.dtype().kind() == b'f' && array.dtype().itemsize() < 8;
    let array: PyReadonlyArray2<'_, f64> = array.call_method1("astype", ("float64",))?.extract()?;
    Ok((array.as_array().rows().into_iter().map(|row| row.to_vec()).collect(), single))
}

/// Rows of indices of an argument, copied.
///
/// # Errors
/// `InputError` where `object` is no table of whole numbers, none of them negative.
pub fn indices(what: &str, object: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<usize>>> {
    let array = two_dimensional(what, object, b"iu", "whole numbers")?;
    let array: PyReadonlyArray2<'_, i64> = array.call_method1("astype", ("int64",))?.extract()?;
    let view: ArrayView2<'_, i64> = array.as_array();
    if let Some(index) = view.iter().find(|index| **index < 0) {
        let message = format!("{what} contains {index}, which is no index");
        return Err(raised(Exit::BadInput, message, "count points from 0"));
    }
    Ok(view.rows().into_iter().map(|row| row.iter().map(|index| *index as usize).collect()).collect())
}

fn two_dimensional<'py>(
    what: &str,
    object: &Bound<'py, PyAny>,
    kinds: &[u8],
    words: &str,
) -> PyResult<Bound<'py, PyUntypedArray>> {
    let refused = |found: String| raised(Exit::BadInput, found, &format!("give an array of rows of {words}"));
    let array = object.py().import("numpy")?.call_method1("asarray", (object,));
    let array = array.map_err(|e| refused(format!("{what} is no array ({e})")))?;
    let array = array.cast_into::<PyUntypedArray>()?;
    if array.ndim() != 2 || !kinds.contains(&array.dtype().kind()) {
        let dtype = array.dtype().str()?;
        return Err(refused(format!("{what} has the shape {:?} and the type {dtype}", array.shape())));
    }
    Ok(array)
}
