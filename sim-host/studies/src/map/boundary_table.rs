//! Boundaries as a table: one row a vertex.

use sprag_report::columns::{Column, FieldTable, Fields, Table};
use sprag_sim::scene::map::MapTable;

use sprag_sim::map::boundaries::{Boundaries, Boundary};
use sprag_sim::map::grid::{Grid, Values};

/// A vertex of a boundary.
struct VertexRow<'m> {
    device: &'m str,
    number: usize,
    boundary: &'m Boundary,
    vertex: Values,
}

fn fields<'m>(map: &MapTable) -> Fields<VertexRow<'m>> {
    let fields = Fields::<VertexRow<'m>>::default()
        .with(Column::text("device"), |row| row.device.into())
        .with(Column::count("boundary"), |row| row.number.into())
        .with(Column::text("left"), |row| row.boundary.left.name().into())
        .with(Column::text("right"), |row| row.boundary.right.name().into())
        .with(Column::number(&map.x.key), |row| row.vertex.0.into());
    match &map.y {
        Some(y) => fields.with(Column::number(&y.key), |row| row.vertex.1.into()),
        None => fields,
    }
}

/// `device`, `boundary` (numbered from 1 for each device), `left` and `right` (the outcomes on either side of a walk from vertex to vertex) and
/// the keys of the axes.
pub fn boundary_table<'m>(grid: &'m Grid, all: &'m [Boundaries]) -> impl Table {
    let vertices = |(of_device, (index, boundary)): (&'m Boundaries, (usize, &'m Boundary))| {
        let row = move |&vertex| VertexRow { device: &of_device.device, number: index + 1, boundary, vertex };
        boundary.vertices.iter().map(row)
    };
    let of_device = |of_device: &'m Boundaries| of_device.boundaries.iter().enumerate().map(move |of| (of_device, of));
    FieldTable { fields: fields(&grid.map), rows: all.iter().flat_map(of_device).flat_map(vertices).collect() }
}
