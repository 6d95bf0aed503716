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

use super::factorial::Effect;
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
pub struct Design {
    /// Number of basic factors, k - p.
    basic: usize,
    /// The words that make the other factors, in the order of these.
    generated: Vec<Word>,
    /// The words of the defining relation but for the identity, short ones first.
    relation: Vec<Word>,
}

impl Design {
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

    /// The levels, +1 or -1, of all factors in each run, in standard order: the first factor
    /// changes fastest.
    pub fn runs(&self) -> Vec<Vec<i8>> {
        let level = |run: usize, factor: usize| if run >> factor & 1 == 1 { 1 } else { -1 };
        (0..1 << self.basic)
            .map(|run| {
                let mut levels: Vec<i8> = (0..self.basic).map(|f| level(run, f)).collect();
                levels.extend(self.generated.iter().map(|w| w.level(&levels)).collect::<Vec<_>>());
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

    /// What a full analysis of the basic factors, effects in standard order, says of the shortest
    /// effect of each set of [`Design::aliases`]; it is the sum of the set's effects.
    ///
    /// # Errors
    /// [`Error::Value`] when there is not one effect a set.
    pub fn estimates(&self, of_basic: &[Effect]) -> Result<Vec<Effect>> {
        let sets = self.aliases();
        if sets.len() != of_basic.len() {
            let reason = format!("the design has {} sets of aliases", sets.len());
            return Err(refuse(&format!("{} effects", of_basic.len()), reason));
        }
        let estimate = |(set, effect): (&Vec<Word>, &Effect)| Effect {
            factors: set[0].factors(),
            value: f64::from(set[0].sign()) * effect.value,
        };
        Ok(sets.iter().zip(of_basic).map(estimate).collect())
    }
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
    use super::super::factorial::analyse;
    use super::*;

    fn words(list: &[Word]) -> Vec<String> {
        list.iter().map(Word::to_string).collect()
    }

    /// The set that `word` is in, without words of more than `longest` letters, joined by " + ".
    fn set_of(design: &Design, word: &str, longest: usize) -> String {
        let wanted = Word::parse(word).unwrap();
        let set = design.aliases().into_iter().find(|set| set.contains(&wanted)).unwrap();
        let short: Vec<Word> = set.into_iter().filter(|w| w.len() <= longest).collect();
        words(&short).join(" + ")
    }

    /// What the words of the defining relation say holds in every run, and the runs are all
    /// different and balanced.
    fn check_runs(design: &Design) {
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
        let design = Design::fractional(5, &["E = ABCD"]).unwrap();
        check_runs(&design);
        assert_eq!(design.runs().len(), 16);
        assert_eq!(words(design.defining_relation()), ["ABCDE"]);
        assert_eq!(design.resolution(), Some(5));
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
        let design = Design::fractional(6, &["E = ABC", "F = BCD"]).unwrap();
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
        let design = Design::fractional(7, &["D = AB", "E = AC", "F = BC", "G = ABC"]).unwrap();
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
        let design = Design::fractional(3, &["C = -AB"]).unwrap();
        check_runs(&design);
        assert_eq!(words(design.defining_relation()), ["-ABC"]);
        assert_eq!(set_of(&design, "A", 3), "A + -BC");
        assert_eq!(set_of(&design, "AB", 3), "-C + AB");
    }

    /// Montgomery, example 8.1: the filtration rates of the half fraction of four factors.
    #[test]
    fn the_filtration_rates_give_the_published_estimates() {
        let design = Design::fractional(4, &["D = ABC"]).unwrap();
        check_runs(&design);
        assert_eq!(design.resolution(), Some(4));
        let rates = [45.0, 100.0, 45.0, 65.0, 75.0, 60.0, 80.0, 96.0];
        let basic: Vec<Vec<i8>> = design.runs().iter().map(|run| run[..3].to_vec()).collect();
        let effects = analyse(&basic, &rates, None).unwrap().effects;
        let found: Vec<(String, f64)> = design
            .estimates(&effects)
            .unwrap()
            .iter()
            .zip(design.aliases())
            .map(|(estimate, set)| {
                assert_eq!(estimate.factors, set[0].factors());
                (words(&set).join(" + "), estimate.value)
            })
            .collect();
        let wanted = [
            ("A + BCD", 19.0),
            ("B + ACD", 1.5),
            ("AB + CD", -1.0),
            ("C + ABD", 14.0),
            ("AC + BD", -18.5),
            ("AD + BC", 19.0),
            ("D + ABC", 16.5),
        ];
        assert_eq!(found, wanted.map(|(set, value)| (set.to_string(), value)));
        assert!(design.estimates(&effects[1..]).is_err());
    }

    #[test]
    fn a_negative_word_turns_its_estimate() {
        let design = Design::fractional(3, &["C = -AB"]).unwrap();
        // The response is the level of C.
        let response: Vec<f64> = design.runs().iter().map(|run| f64::from(run[2])).collect();
        let basic: Vec<Vec<i8>> = design.runs().iter().map(|run| run[..2].to_vec()).collect();
        let effects = analyse(&basic, &response, None).unwrap().effects;
        let estimates = design.estimates(&effects).unwrap();
        assert_eq!(estimates[2], Effect { factors: vec![2], value: 2.0 });
    }

    #[test]
    fn a_full_design_has_no_aliases() {
        let design = Design::full(3).unwrap();
        check_runs(&design);
        assert_eq!((design.runs().len(), design.resolution()), (8, None));
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
            let said = Design::fractional(factors, generators).unwrap_err().to_string();
            assert!(said.contains(wanted), "{generators:?}: {said}");
        }
    }
}
