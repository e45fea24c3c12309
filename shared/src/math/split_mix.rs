//! SplitMix64: a random word for each number of a seed, so that a draw depends on nothing else. Steele, Lea and Flood (2014), Fast splittable
//! pseudorandom number generators, OOPSLA.

/// Step of its state from one number to the next.
const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// Word number `number` of `seed`, counted from 1 as the generator gives them.
pub fn word(seed: u64, number: u64) -> u64 {
    let mut z = seed.wrapping_add(number.wrapping_mul(GAMMA));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first words of seed 1234567 as of the authors' own program (`splitmix64.c`).
    #[test]
    fn words_are_those_of_the_generator() {
        let words = [1, 2, 3, 4, 5].map(|number| word(1_234_567, number));
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        assert_eq!(words, expected);
    }
}
