//! A saved state as bytes.

use super::state::{State, StateSet};

/// What a blob begins with: what it is, and the version of its form.
const MAGIC: [u8; 8] = *b"StrutS\x00\x01";

/// What is in a blob.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Content<'a> {
    /// Kind and phase.
    pub state: State,
    /// Stop time.
    pub stop: f64,
    /// The simulation's snapshot.
    pub snapshot: &'a [u8],
}

/// The bytes of a saved state: magic, GUID with its length, state, stop time, snapshot with its length,
/// checksum; numbers in little endian.
pub fn write(guid: &str, content: Content<'_>) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    for part in [guid.as_bytes(), content.snapshot] {
        bytes.extend((part.len() as u64).to_le_bytes());
        bytes.extend(part);
    }
    bytes.extend(content.stop.to_le_bytes());
    bytes.extend(content.state.to_bits().to_le_bytes());
    bytes.extend(checksum(&bytes).to_le_bytes());
    bytes
}

/// What was written, in one of the states that an instance can be in.
///
/// # Errors
/// What is wrong with the bytes, as the end of a sentence.
pub fn read<'a>(guid: &str, states: StateSet, bytes: &'a [u8]) -> Result<Content<'a>, &'static str> {
    let rest = bytes.strip_prefix(&MAGIC).ok_or("they are no state saved by this version of a Strut FMU")?;
    let (owner, rest) = part(rest).ok_or(CUT)?;
    if owner != guid.as_bytes() {
        return Err("they were saved by an FMU with another GUID: restore them with the FMU that saved them");
    }
    let (snapshot, rest) = part(rest).ok_or(CUT)?;
    let (stop, rest) = rest.split_first_chunk().ok_or(CUT)?;
    let (state, rest) = rest.split_first_chunk().ok_or(CUT)?;
    if *rest != checksum(&bytes[..bytes.len() - rest.len()]).to_le_bytes() {
        return Err("their checksum is wrong: they were damaged since they were saved");
    }
    let state = states.state(u16::from_le_bytes(*state)).ok_or("they name a state that does not exist")?;
    Ok(Content { state, stop: f64::from_le_bytes(*stop), snapshot })
}

const CUT: &str = "they end too early or their lengths are wrong: hand over all of the bytes that were saved";

/// A part with its length before it, and what follows.
fn part(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (len, rest) = bytes.split_first_chunk()?;
    rest.split_at_checked(usize::try_from(u64::from_le_bytes(*len)).ok()?)
}

/// FNV-1a: every change of a single byte changes it.
fn checksum(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::super::state::{Kind, Phase};
    use super::*;
    use proptest::prelude::*;

    /// Those of the example.
    const STATES: StateSet = StateSet::from_bits(u16::MAX);
    const GUID: &str = "{12345678-1234-1234-1234-123456789abc}";

    fn example(snapshot: &[u8]) -> Content<'_> {
        Content { state: State::new(Kind::CoSimulation, Phase::StepComplete), stop: 10.0, snapshot }
    }

    #[test]
    fn the_checksum_is_the_published_one() {
        assert_eq!((checksum(b""), checksum(b"foobar")), (0xcbf2_9ce4_8422_2325, 0x8594_4171_f739_67e8));
    }

    #[test]
    fn another_fmu_is_told() {
        let error = read("{other}", STATES, &write(GUID, example(b"abc"))).unwrap_err();
        assert!(error.contains("another GUID"), "{error}");
    }

    proptest! {
        #[test]
        fn what_was_written_is_read(snapshot: Vec<u8>) {
            let bytes = write(GUID, example(&snapshot));
            prop_assert_eq!(read(GUID, STATES, &bytes), Ok(example(&snapshot)));
        }

        #[test]
        fn damage_is_told(snapshot: Vec<u8>, place: prop::sample::Index, change in 1_u8.., cut: prop::sample::Index) {
            let bytes = write(GUID, example(&snapshot));
            let mut damaged = bytes.clone();
            damaged[place.index(bytes.len())] ^= change;
            prop_assert!(read(GUID, STATES, &damaged).is_err());
            prop_assert!(read(GUID, STATES, &bytes[..cut.index(bytes.len())]).is_err());
            let longer = [bytes, vec![0]].concat();
            prop_assert!(read(GUID, STATES, &longer).is_err());
        }

        #[test]
        fn any_bytes_are_told(bytes: Vec<u8>) {
            prop_assert!(read(GUID, STATES, &bytes).is_err());
            prop_assert!(read(GUID, STATES, &[&MAGIC[..], &bytes].concat()).is_err());
        }
    }
}
