//! Two-level designs, full and fractional, and their aliases.
//!
//! A design 2^(k-p) has k factors, each at two levels, in 2^(k-p) runs. The first k - p factors are
//! the basic factors; the runs contain all combinations of their levels. Each other factor is a
//! product of basic factors, which its generator names: `E = ABCD`. A product of factors that is
//! the same in all runs is a word of the defining relation. Two effects are aliases if their
//! product is such a word: only their sum can be estimated. The resolution is the length of the
//! shortest word. In a design of resolution III a main effect is confounded with interactions of
//! two factors, in one of resolution V with those of four.
//!
//! Source: D. C. Montgomery, "Design and Analysis of Experiments", 8th edition, 2013, chapter 8.
//! Its examples are the tests.

use crate::base::{Error, Result};
use std::fmt;

/// Letters of the factors, in their order; I is the identity.
const LETTERS: &[u8] = b"ABCDEFGHJKLMNOP";

/// Largest number of runs of a design; a larger one is a mistake.
const MAX_RUNS: usize = 4096;

/// A product of factors with its sign, such as `-ABD`; without a factor it is `I`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Word {
    /// A bit for each factor, the first factor's lowest.
    factors: u32,
    negative: bool,
}

impl Word {
    /// Reads a word such as `ABC` or `-BD`. `None` if a letter is no factor or occurs twice.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let (letters, negative) = match text.strip_prefix('-') {
            Some(rest) => (rest.trim(), true),
            None => (text, false),
        };
        let mut factors = 0;
        for letter in letters.bytes() {
            let bit = 1 << LETTERS.iter().position(|known| *known == letter)?;
            if factors & bit != 0 {
                return None;
            }
            factors |= bit;
        }
        (factors != 0).then_some(Self { factors, negative })
    }

    /// Indices of its factors, ascending.
    pub fn factors(self) -> Vec<usize> {
        (0..LETTERS.len()).filter(|i| self.factors >> i & 1 == 1).collect()
    }

    /// Number of its factors.
    pub fn len(self) -> usize {
        self.factors.count_ones() as usize
    }

    /// Whether it has no factor: it is the identity.
    pub fn is_empty(self) -> bool {
        self.factors == 0
    }

    /// +1 or -1.
    pub fn sign(self) -> i8 {
        if self.negative { -1 } else { 1 }
    }

    /// The word with the other sign.
    #[must_use]
    pub fn negated(self) -> Self {
        Self { negative: !self.negative, ..self }
    }

    /// The product of two words; a factor that is in both drops out.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self { factors: self.factors ^ other.factors, negative: self.negative != other.negative }
    }

    /// Its level, +1 or -1, in a run with these levels of the factors.
    pub fn level(self, run: &[i8]) -> i8 {
        self.factors().into_iter().map(|i| run[i]).product::<i8>() * self.sign()
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.negative {
            f.write_str("-")?;
        }
        if self.is_empty() {
            return f.write_str("I");
        }
        self.factors().into_iter().try_for_each(|i| write!(f, "{}", char::from(LETTERS[i])))
    }
}

/// A two-level design 2^(k-p).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TwoLevel {
    /// Number of basic factors, k - p.
    basic: usize,
    /// The words that make the other factors, in the order of these.
    generated: Vec<Word>,
    /// The words of the defining relation but for the identity, short ones first.
    relation: Vec<Word>,
}

impl TwoLevel {
    /// The full design of `factors` factors, at least one.
    ///
    /// # Errors
    /// [`Error::Value`] for no factor, or for more runs than 4096.
    pub fn full(factors: usize) -> Result<Self> {
        Self::fractional(factors, &[])
    }

    /// The design of `factors` factors with a generator for each of the last ones, in their order:
    /// `["F = ABC", "G = -ABD"]` for 7 factors. The right-hand sides name basic factors only.
    ///
    /// # Errors
    /// [`Error::Value`] when a generator does not read so, when two factors always have the same
    /// level or opposite ones, or for more runs than 4096.
    pub fn fractional(factors: usize, generators: &[&str]) -> Result<Self> {
        let basic = factors.saturating_sub(generators.len());
        if basic == 0 || factors > LETTERS.len() || 1 << basic > MAX_RUNS {
            return Err(refuse(
                &format!("{factors} factors, {} generators", generators.len()),
                format!("a design has 1 to {} factors and up to {MAX_RUNS} runs", LETTERS.len()),
            ));
        }
        let mut generated: Vec<Word> = Vec::new();
        for (text, factor) in generators.iter().zip(basic..) {
            let word = read_generator(text, factor, basic)?;
            if word.len() < 2 || generated.iter().any(|known| known.factors == word.factors) {
                let reason = "it gives two factors the same levels or opposite ones";
                return Err(refuse(text, reason.into()));
            }
            generated.push(word);
        }
        let relation = defining_relation(basic, &generated);
        Ok(Self { basic, generated, relation })
    }

    /// Number of factors.
    pub fn factors(&self) -> usize {
        self.basic + self.generated.len()
    }

    /// Number of basic factors, the first ones.
    pub fn basic(&self) -> usize {
        self.basic
    }

    /// Whether its runs are a fraction of all combinations.
    pub fn is_fractional(&self) -> bool {
        !self.generated.is_empty()
    }

    /// The letter of a factor.
    pub fn letter(factor: usize) -> char {
        char::from(LETTERS[factor])
    }

    /// The levels of the other factors at these levels of the basic ones.
    pub fn generated(&self, basic: &[i8]) -> Vec<i8> {
        self.generated.iter().map(|word| word.level(basic)).collect()
    }

    /// The levels, +1 or -1, of all factors in each run, in standard order: the first factor
    /// changes fastest.
    pub fn runs(&self) -> Vec<Vec<i8>> {
        let level = |run: usize, factor: usize| if run >> factor & 1 == 1 { 1 } else { -1 };
        (0..1 << self.basic)
            .map(|run| {
                let mut levels: Vec<i8> = (0..self.basic).map(|f| level(run, f)).collect();
                levels.extend(self.generated(&levels));
                levels
            })
            .collect()
    }

    /// The words that are +1 in all runs, but for the identity; short ones first. None for a full
    /// design.
    pub fn defining_relation(&self) -> &[Word] {
        &self.relation
    }

    /// The length of the shortest word of the defining relation; `None` for a full design.
    pub fn resolution(&self) -> Option<usize> {
        self.relation.iter().map(|word| word.len()).min()
    }

    /// The effects that are confounded with each other: one set for each product of basic factors
    /// but the identity, in standard order (A, B, AB, C and so on). In a set shorter words stand
    /// first; each has the sign that makes it equal to the product of basic factors.
    pub fn aliases(&self) -> Vec<Vec<Word>> {
        (1..1 << self.basic)
            .map(|factors| {
                let own = Word { factors, negative: false };
                let mut set = vec![own];
                set.extend(self.relation.iter().map(|word| word.times(own)));
                set.sort_by_key(|word| order(*word));
                set
            })
            .collect()
    }
}

impl fmt::Display for TwoLevel {
    /// `2^3, full` or `2^(5-1), resolution V`.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.resolution() {
            None => write!(f, "2^{}, full", self.basic),
            Some(resolution) => {
                let (factors, made) = (self.factors(), self.generated.len());
                write!(f, "2^({factors}-{made}), resolution {}", roman(resolution))
            }
        }
    }
}

/// A number below 40 in Roman numerals, as resolutions are written.
fn roman(number: usize) -> String {
    let ones = ["", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX"];
    "X".repeat(number / 10) + ones[number % 10]
}

/// Some effects as a sum: `AB + CE - ADF`.
pub fn sum(words: &[Word]) -> String {
    let mut text = String::new();
    for (i, word) in words.iter().enumerate() {
        match (i, word.negative) {
            (0, _) => text += &word.to_string(),
            (_, false) => text += &format!(" + {word}"),
            (_, true) => text += &format!(" - {}", word.negated()),
        }
    }
    text
}

/// A set of aliases with the signs that make the first positive.
pub fn positive(set: &[Word]) -> Vec<Word> {
    let turned = set.first().is_some_and(|word| word.negative);
    set.iter().map(|word| if turned { word.negated() } else { *word }).collect()
}

/// The aliases of an effect that may matter: those of up to three factors, and the shortest in any
/// case.
pub fn short(aliases: &[Word]) -> &[Word] {
    let most = aliases.first().map_or(0, |word| word.len().max(3));
    &aliases[..aliases.partition_point(|word| word.len() <= most)]
}

/// By length, then by the alphabet.
fn order(word: Word) -> (usize, u32) {
    (word.len(), word.factors.reverse_bits() ^ u32::MAX)
}

/// The product of basic factors that makes `factor`.
fn read_generator(text: &str, factor: usize, basic: usize) -> Result<Word> {
    let letter = char::from(LETTERS[factor]);
    let product = text
        .split_once('=')
        .filter(|(left, _)| left.trim() == letter.to_string())
        .and_then(|(_, right)| Word::parse(right))
        .filter(|word| word.factors >> basic == 0);
    product.ok_or_else(|| {
        let last = char::from(LETTERS[basic - 1]);
        refuse(text, format!("the generator of {letter} is a product of the factors A to {last}"))
    })
}

/// All products of the generators' words.
fn defining_relation(basic: usize, generated: &[Word]) -> Vec<Word> {
    let identity = Word { factors: 0, negative: false };
    let mut words = vec![identity];
    for (i, product) in generated.iter().enumerate() {
        let word = product.times(Word { factors: 1 << (basic + i), negative: false });
        let more: Vec<Word> = words.iter().map(|known| known.times(word)).collect();
        words.extend(more);
    }
    words.retain(|word| !word.is_empty());
    words.sort_by_key(|word| order(*word));
    words
}

fn refuse(value: &str, reason: String) -> Error {
    Error::Value {
        key: "design".into(),
        value: value.into(),
        reason,
        remedy: "write generators like E = ABCD, one for each factor beyond the basic ones".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(list: &[Word]) -> Vec<String> {
        list.iter().map(Word::to_string).collect()
    }

    /// The set that `word` is in, without words of more than `longest` letters, joined by " + ".
    fn set_of(design: &TwoLevel, word: &str, longest: usize) -> String {
        let wanted = Word::parse(word).unwrap();
        let set = design.aliases().into_iter().find(|set| set.contains(&wanted)).unwrap();
        let short: Vec<Word> = set.into_iter().filter(|w| w.len() <= longest).collect();
        sum(&short)
    }

    /// What the words of the defining relation say holds in every run, and the runs are all
    /// different and balanced.
    fn check_runs(design: &TwoLevel) {
        let runs = design.runs();
        for word in design.defining_relation() {
            assert!(runs.iter().all(|run| word.level(run) == 1), "{word}");
        }
        for (i, run) in runs.iter().enumerate() {
            assert!(!runs[..i].contains(run));
        }
        for a in 0..design.factors() {
            assert_eq!(runs.iter().map(|run| i32::from(run[a])).sum::<i32>(), 0);
            for b in 0..a {
                assert_eq!(runs.iter().map(|run| i32::from(run[a] * run[b])).sum::<i32>(), 0);
            }
        }
        // Every effect but those of the relation is in exactly one set.
        let mut all: Vec<u32> = design.aliases().concat().iter().map(|w| w.factors).collect();
        all.extend(design.defining_relation().iter().map(|w| w.factors));
        all.sort_unstable();
        assert_eq!(all, (1..1 << design.factors()).collect::<Vec<u32>>());
    }

    /// Montgomery, section 8.2: the half fraction of five factors.
    #[test]
    fn five_factors_in_sixteen_runs_have_resolution_five() {
        let design = TwoLevel::fractional(5, &["E = ABCD"]).unwrap();
        check_runs(&design);
        assert_eq!(design.runs().len(), 16);
        assert_eq!(words(design.defining_relation()), ["ABCDE"]);
        assert_eq!(design.resolution(), Some(5));
        assert_eq!(design.to_string(), "2^(5-1), resolution V");
        assert_eq!(set_of(&design, "A", 5), "A + BCDE");
        assert_eq!(set_of(&design, "E", 5), "E + ABCD");
        assert_eq!(set_of(&design, "DE", 5), "DE + ABC");
        // The first runs of the table: e, a, b, abe.
        let first = [[-1, -1, -1, -1, 1], [1, -1, -1, -1, -1], [-1, 1, -1, -1, -1]];
        assert_eq!(design.runs()[..3], first);
        assert_eq!(design.runs()[3], [1, 1, -1, -1, 1]);
    }

    /// Montgomery, section 8.3: the quarter fraction of six factors, table 8.8.
    #[test]
    fn six_factors_in_sixteen_runs_have_resolution_four() {
        let design = TwoLevel::fractional(6, &["E = ABC", "F = BCD"]).unwrap();
        check_runs(&design);
        assert_eq!(words(design.defining_relation()), ["ABCE", "ADEF", "BCDF"]);
        assert_eq!(design.resolution(), Some(4));
        for (of, wanted) in [
            ("A", "A + BCE + DEF + ABCDF"),
            ("B", "B + ACE + CDF + ABDEF"),
            ("C", "C + ABE + BDF + ACDEF"),
            ("D", "D + AEF + BCF + ABCDE"),
            ("E", "E + ABC + ADF + BCDEF"),
            ("F", "F + ADE + BCD + ABCEF"),
            ("AB", "AB + CE + ACDF + BDEF"),
            ("AC", "AC + BE + ABDF + CDEF"),
            ("AD", "AD + EF + ABCF + BCDE"),
            ("AE", "AE + BC + DF + ABCDEF"),
            ("AF", "AF + DE + ABCD + BCEF"),
            ("BD", "BD + CF + ABEF + ACDE"),
            ("BF", "BF + CD + ABDE + ACEF"),
            ("ABD", "ABD + ACF + BEF + CDE"),
            ("ACD", "ABF + ACD + BDE + CEF"),
        ] {
            assert_eq!(set_of(&design, of, 6), wanted);
        }
    }

    /// Montgomery, section 8.5: the saturated design of seven factors in eight runs.
    #[test]
    fn seven_factors_in_eight_runs_have_resolution_three() {
        let design = TwoLevel::fractional(7, &["D = AB", "E = AC", "F = BC", "G = ABC"]).unwrap();
        check_runs(&design);
        let relation = "ABD ACE AFG BCF BEG CDG DEF ABCG ABEF ACDF ADEG BCDE BDFG CEFG ABCDEFG";
        assert_eq!(words(design.defining_relation()).join(" "), relation);
        assert_eq!(design.resolution(), Some(3));
        for wanted in [
            "A + BD + CE + FG",
            "B + AD + CF + EG",
            "C + AE + BF + DG",
            "D + AB + CG + EF",
            "E + AC + BG + DF",
            "F + AG + BC + DE",
            "G + AF + BE + CD",
        ] {
            assert_eq!(set_of(&design, &wanted[..1], 2), wanted);
        }
        // The row of the book's table where all of the basic factors are high.
        assert_eq!(design.runs()[7], [1; 7]);
        assert_eq!(design.runs()[0], [-1, -1, -1, 1, 1, 1, -1]);
    }

    /// The other half of three factors: I = -ABC, so A and -BC cannot be told apart.
    #[test]
    fn the_other_half_has_the_other_signs() {
        let design = TwoLevel::fractional(3, &["C = -AB"]).unwrap();
        check_runs(&design);
        assert_eq!(words(design.defining_relation()), ["-ABC"]);
        assert_eq!(set_of(&design, "A", 3), "A - BC");
        assert_eq!(set_of(&design, "AB", 3), "-C + AB");
    }

    #[test]
    fn a_full_design_has_no_aliases() {
        let design = TwoLevel::full(3).unwrap();
        check_runs(&design);
        assert_eq!((design.runs().len(), design.resolution()), (8, None));
        assert_eq!(design.to_string(), "2^3, full");
        assert!(design.aliases().iter().all(|set| set.len() == 1));
        assert_eq!(words(&design.aliases().concat()).join(" "), "A B AB C AC BC ABC");
    }

    #[test]
    fn generators_that_make_no_design_are_refused() {
        for (factors, generators, wanted) in [
            (
                5,
                &["D = ABC"][..],
                "design = D = ABC is not valid: the generator of E is a product of",
            ),
            (5, &["E = ABX"], "the factors A to D"),
            (5, &["E = AA"], "the factors A to D"),
            (5, &["E = ABE"], "the factors A to D"),
            (5, &["E ABC"], "write generators like E = ABCD"),
            (5, &["E = A"], "it gives two factors the same levels"),
            (6, &["E = ABC", "F = -ABC"], "design = F = -ABC is not valid: it gives two factors"),
            (1, &["A = B"], "a design has 1 to 15 factors"),
            (0, &[], "0 factors, 0 generators"),
            (14, &[], "up to 4096 runs"),
        ] {
            let said = TwoLevel::fractional(factors, generators).unwrap_err().to_string();
            assert!(said.contains(wanted), "{generators:?}: {said}");
        }
    }
}
