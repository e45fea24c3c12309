//! The seal of an image: which stretches of flash the program takes, and a CRC-32 over them, written into the ELF file after it has been
//! linked. `firmware/src/seal.rs` has the other half.

use crate::stop::Stop;
use object::{
    LittleEndian, Object as _, ObjectSymbol as _,
    elf::PT_LOAD,
    read::elf::{ElfFile32, ProgramHeader as _},
};
use std::{fs, ops::Range, path::Path};

/// The name of the place that is left for it.
const SYMBOL: &str = "SPRAG_SEAL";

/// Its first word where it has been written; `SEALED` there.
const MARK: u32 = 0x5EA1_ED01;

/// Stretches that it has room for: the vectors, code, and constants before and after the seal.
const STRETCHES: usize = 4;

/// Bytes of it: mark, first and last address of each stretch, CRC.
const BYTES: u32 = 4 * (2 + 2 * STRETCHES as u32);

/// Writes the seal into the file at `elf`.
///
/// # Errors
/// If it is no program with room for one.
pub fn seal(elf: &Path) -> Result<(), Stop> {
    let fault = |error: &dyn std::fmt::Display| Stop::failed(format!("{}: {error}", elf.display()));
    let mut bytes = fs::read(elf).map_err(|error| fault(&error))?;
    let (offset, seal) = seal_of(&bytes).map_err(|error| fault(&error))?;
    bytes.get_mut(offset..offset + seal.len()).ok_or_else(|| fault(&"the seal is not in the file"))?.copy_from_slice(&seal);
    fs::write(elf, bytes).map_err(|error| fault(&error))
}

/// Where in a file its seal goes, and what it is.
fn seal_of(bytes: &[u8]) -> Result<(usize, Vec<u8>), String> {
    let file = ElfFile32::<LittleEndian>::parse(bytes).map_err(|error| error.to_string())?;
    let symbol = file.symbols().find(|symbol| symbol.name() == Ok(SYMBOL)).ok_or("it has no place for a seal")?;
    let place = symbol.address() as u32;
    let loaded = loaded(&file, bytes)?;
    let (start, content) = loaded
        .iter()
        .find(|(start, content)| (*start..*start + content.len() as u32).contains(&place))
        .ok_or("the seal is not loaded")?;
    // From the file's beginning: the contents are slices of it.
    let offset = content.as_ptr() as usize - bytes.as_ptr() as usize + (place - start) as usize;
    Ok((offset, words_of(&loaded, place)?.iter().flat_map(|word| word.to_le_bytes()).collect()))
}

/// What is loaded, and to where in flash.
fn loaded<'a>(file: &ElfFile32<'a, LittleEndian>, bytes: &'a [u8]) -> Result<Vec<(u32, &'a [u8])>, String> {
    let endian = file.endian();
    let mut loaded = Vec::new();
    for header in
        file.elf_program_headers().iter().filter(|header| header.p_type(endian) == PT_LOAD && header.p_filesz(endian) > 0)
    {
        let content = header.data(endian, bytes).map_err(|()| "a segment is not in the file".to_owned())?;
        loaded.push((header.p_paddr(endian), content));
    }
    loaded.sort_by_key(|(start, _)| *start);
    Ok(loaded)
}

/// The words of a seal at `place`.
fn words_of(loaded: &[(u32, &[u8])], place: u32) -> Result<Vec<u32>, String> {
    let mut stretches: Vec<Range<u32>> = Vec::new();
    for (start, content) in loaded {
        let end = start + content.len() as u32;
        // The seal itself is left out.
        for stretch in [*start..end.min(place), (*start).max(place + BYTES)..end] {
            match stretches.last_mut() {
                _ if stretch.is_empty() => {}
                Some(last) if last.end == stretch.start => last.end = stretch.end,
                _ => stretches.push(stretch),
            }
        }
    }
    if stretches.len() > STRETCHES || stretches.iter().any(|stretch| stretch.start % 4 != 0 || stretch.end % 4 != 0) {
        return Err(format!("these stretches are too many, or no whole words: {stretches:x?}"));
    }
    let mut words = vec![MARK];
    for index in 0..STRETCHES {
        let stretch = stretches.get(index).cloned().unwrap_or(0..0);
        words.extend([stretch.start, stretch.end]);
    }
    let byte = |address: u32| {
        let (start, content) = loaded.iter().rfind(|(start, _)| *start <= address)?;
        content.get((address - start) as usize).copied()
    };
    let head = words.iter().flat_map(|word| word.to_le_bytes());
    let program: Vec<u8> = stretches.into_iter().flatten().filter_map(byte).collect();
    let all: Vec<u8> = head.chain(program).collect();
    words.push(crc(all.chunks_exact(4).map(|word| word.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte)))));
    Ok(words)
}

/// CRC-32/MPEG-2 of words, each from its most significant bit on, as the chips' own units compute it.
fn crc(words: impl Iterator<Item = u32>) -> u32 {
    words.fold(u32::MAX, |crc, word| (0..32).fold(crc ^ word, |crc, _| crc << 1 ^ if crc >> 31 == 1 { 0x04C1_1DB7 } else { 0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By way of bytes, whose check value of "123456789" is published: 0x0376_E6E7.
    #[test]
    fn words_are_taken_from_their_most_significant_bit_on() {
        let by_bytes = |crc: u32, bytes: &[u8]| {
            bytes.iter().fold(crc, |crc, byte| {
                (0..8).fold(crc ^ u32::from(*byte) << 24, |crc, _| crc << 1 ^ if crc >> 31 == 1 { 0x04C1_1DB7 } else { 0 })
            })
        };
        assert_eq!(by_bytes(u32::MAX, b"123456789"), 0x0376_E6E7);
        assert_eq!(by_bytes(crc([0x3132_3334, 0x3536_3738].into_iter()), b"9"), 0x0376_E6E7);
    }

    #[test]
    fn stretches_leave_the_seal_out_and_nothing_else() {
        let program: Vec<u8> = (0..96).collect();
        let loaded = [(0x0800_0000, &program[..16]), (0x0801_0000, &program[16..80]), (0x0801_0040, &program[80..])];
        let words = words_of(&loaded, 0x0801_0010).unwrap();
        assert_eq!(words[..7], [MARK, 0x0800_0000, 0x0800_0010, 0x0801_0000, 0x0801_0010, 0x0801_0038, 0x0801_0050]);
        // A bit anywhere changes it, but not one of the seal itself.
        for index in 0..96 {
            let mut other = program.clone();
            other[index] ^= 0x10;
            let loaded = [(0x0800_0000, &other[..16]), (0x0801_0000, &other[16..80]), (0x0801_0040, &other[80..])];
            let changed = words_of(&loaded, 0x0801_0010).unwrap();
            assert_eq!(changed == words, (32..72).contains(&index), "byte {index}");
        }
    }

    #[test]
    fn a_file_without_room_for_one_is_refused() {
        assert!(seal_of(b"not an ELF file").is_err());
        assert!(words_of(&[(2, &[0; 6])], 0x100).is_err());
        let scattered: Vec<(u32, &[u8])> = (0..5).map(|place| (0x100 * place, &[0_u8; 4][..])).collect();
        assert!(words_of(&scattered, 0x1000).is_err());
    }
}
