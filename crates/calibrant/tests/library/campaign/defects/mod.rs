//! Recordings with one defect each: none gives a wrong result without a word.

mod fate;
mod kind;

use fate::Fate;
use kind::Kind;
use rayon::prelude::*;

/// Recordings.
const COUNT: u64 = 300;

#[test]
#[ignore = "long: scripts/test-all runs it"]
fn no_defect_gives_a_wrong_result_without_a_word() {
    let fates: Vec<Fate> = (0..COUNT).into_par_iter().map(Fate::of).collect();
    print_table(&fates);
    let wrong: Vec<&Fate> = fates.iter().filter(|fate| fate.is_wrong()).collect();
    let silent: Vec<&&Fate> = wrong.iter().filter(|fate| fate.is_silent()).collect();
    let named = wrong.iter().filter(|fate| fate.is_named()).count();
    let flagged = wrong.len() - silent.len();
    println!("of {} that are wrong or refused {flagged} are flagged, {named} named", wrong.len());
    assert!(silent.is_empty(), "{silent:#?}");
    assert!(flagged * 100 >= 82 * wrong.len() && named * 100 >= 67 * wrong.len(), "{flagged} {named}");
}

fn print_table(fates: &[Fate]) {
    let columns = ["count", "silent", "… and wrong", "flagged", "named", "refused", "wrong"];
    println!("{:17} size {}", "kind", columns.map(|column| format!("{column:>12}")).concat());
    for (kind, size) in Kind::ALL.into_iter().flat_map(|kind| (0..4).map(move |size| (kind, size))) {
        let of: Vec<&Fate> = fates.iter().filter(|fate| (fate.kind, fate.size) == (kind, size)).collect();
        let count = |is: fn(&Fate) -> bool| of.iter().filter(|fate| is(fate)).count();
        let counts = [
            of.len(),
            count(Fate::is_silent),
            count(|fate| fate.is_silent() && fate.is_wrong()),
            count(|fate| !fate.is_silent()),
            count(Fate::is_named),
            count(Fate::is_refused),
            count(Fate::is_wrong),
        ];
        println!(
            "{:17} {size:4} {}",
            format!("{kind:?}"),
            counts.map(|count| format!("{count:12}")).concat()
        );
    }
}
