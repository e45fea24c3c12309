//! Boundaries as a table: one row a vertex.

use sprag_report::columns::{Column, Fields, RowWriter, Table, TableError};
use sprag_sim::scene::map::MapTable;

use super::boundaries::{Boundaries, Boundary};
use super::grid::{Grid, Values};

/// `device`, `boundary` (numbered from 1 for each device), `left` and `right` (the outcomes on either side of a walk from vertex to vertex) and
/// the keys of the axes.
#[derive(Clone, Copy)]
pub struct BoundaryTable<'m> {
    /// The axes.
    pub grid: &'m Grid,
    /// The boundaries of every device.
    pub all: &'m [Boundaries],
}

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

impl Table for BoundaryTable<'_> {
    fn columns(&self) -> Vec<Column> {
        fields(&self.grid.map).columns()
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let fields = fields(&self.grid.map);
        for of_device in self.all {
            for (index, boundary) in of_device.boundaries.iter().enumerate() {
                for &vertex in &boundary.vertices {
                    fields.row(&VertexRow { device: &of_device.device, number: index + 1, boundary, vertex }, writer)?;
                }
            }
        }
        Ok(())
    }
}
