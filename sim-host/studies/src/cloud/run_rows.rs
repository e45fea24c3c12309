//! Runs as rows of runs.csv, written part by part and read back to the same bits.

use csv::StringRecord;
use sprag_report::columns::{Column, CsvWriter, Table, TableError};
use sprag_report::long_run::row_fields::RowFields;

use super::measure::Measure;
use super::runs::{Answer, Run, RunList};
use super::typed_tables::runs_table;

impl RunList<'_> {
    fn table<'s>(&'s self, runs: &'s [Run]) -> impl Table {
        runs_table(self.study, self.records, runs)
    }

    /// The columns of its rows.
    pub fn columns(&self) -> Vec<Column> {
        self.table(&[]).columns()
    }

    /// The rows of `runs`, without the heading.
    pub fn text(&self, runs: &[Run]) -> Result<Vec<u8>, TableError> {
        let mut writer = CsvWriter::resumed(self.columns(), Vec::new());
        self.table(runs).rows(&mut writer)?;
        writer.finish()
    }

    /// The run of row number `row`.
    ///
    /// # Errors
    /// When it is the row of another run, or none.
    pub fn read(&self, row: usize, record: &StringRecord) -> Result<Run, String> {
        let names: Vec<String> = self.columns().into_iter().map(|column| column.name).collect();
        let mut fields = RowFields::new(&names, record);
        let expected = self.run(row, [0.0; Measure::COUNT], Err(String::new()));
        let of_run = [
            &self.records[expected.record].name,
            &self.study.structures[expected.structure].name,
            &self.study.devices[expected.device],
        ];
        for name in of_run {
            fields.require(name)?;
        }
        fields.require(&format!("{:?}", expected.factor))?;
        fields.require(&expected.level.map_or_else(String::new, |level| format!("{level:?}")))?;
        let mut measures = [0.0; Measure::COUNT];
        for measure in &mut measures {
            *measure = fields.number()?;
        }
        let Some(outcome) = fields.outcome()? else {
            fields.skip(4);
            let reason = fields.text().to_owned();
            return Ok(self.run(row, measures, Err(reason)));
        };
        let [peak_rotation, peak_acceleration] = [fields.maybe()?, fields.maybe()?];
        let impacts = fields.number::<u32>()?;
        let end_time_s = fields.number()?;
        let _failure = fields.text();
        let error = fields.error_estimate()?;
        let answer = Answer { outcome, peak_rotation, peak_acceleration, impacts, end_time_s, error };
        Ok(self.run(row, measures, Ok(answer)))
    }
}
