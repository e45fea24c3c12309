//! What effects cost, as measured: the rows of `docs/effects-cost.csv`.

use serde::Serialize;

/// The committed table, with a header line.
const TABLE: &str = include_str!("../../../../docs/effects-cost.csv");

/// Cost of an effect a step: on the host what it adds to the same scene without it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Instructions on the host.
    pub host_instructions: String,
    /// Time on the host, ns.
    pub host_ns: String,
    /// Instructions of a whole step on the microcontroller with it.
    pub target_instructions: String,
}

/// What the effect `name` costs; `None` where it has not been measured.
pub fn cost(name: &str) -> Option<Cost> {
    find(TABLE, name)
}

fn find(table: &str, name: &str) -> Option<Cost> {
    table.lines().skip(1).find_map(|row| {
        let mut fields = row.split(',').map(|field| field.trim().to_owned());
        if fields.next()? != name {
            return None;
        }
        Some(Cost { host_instructions: fields.next()?, host_ns: fields.next()?, target_instructions: fields.next()? })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_found_by_its_effect_and_a_missing_one_is_not() {
        let table = "effect,host_instructions,host_ns,target_instructions\nrack,12.5,3.1,40\nclutch,1\n";
        let cost = find(table, "rack").unwrap();
        assert_eq!([cost.host_instructions, cost.host_ns, cost.target_instructions], ["12.5", "3.1", "40"]);
        assert!(find(table, "clutch").is_none() && find(table, "weight").is_none() && find("", "rack").is_none());
    }

    #[test]
    fn the_committed_table_has_known_effects_only() {
        assert_eq!(TABLE.lines().next(), Some("effect,host_instructions,host_ns,target_instructions"));
        for row in TABLE.lines().skip(1) {
            let name = row.split(',').next().unwrap();
            assert!(crate::effect::find(name).is_some() && cost(name).is_some(), "{row}");
        }
    }
}
