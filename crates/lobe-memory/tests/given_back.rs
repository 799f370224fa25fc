//! The memory that the system gets back when a host drops its tables. This test has its own program, because other
//! tests would take memory at the same time.
#![cfg(target_os = "linux")]

use lobe_memory::Storage;

const MB: usize = 1 << 20;

/// The resident memory of this process in bytes.
fn resident() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").expect("the status of this process");
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("a size");
    line.trim().trim_end_matches(" kB").parse::<usize>().expect("a number") * 1024
}

/// A table of this many bytes, all of them written.
fn table(bytes: usize) -> Storage<u8> {
    let mut table = Storage::<u8>::zeros(bytes);
    assert!(table.as_slice().iter().all(|&byte| byte == 0));
    table.as_mut_slice().fill(7);
    table
}

/// The bound on resident memory while tables of `held` bytes are in use: these and the program itself take less.
fn most(held: usize) -> usize {
    held + 72 * MB
}

#[test]
fn memory_goes_back_to_the_system() {
    let sizes = |round: usize| (0..60).map(move |i| (64 << 10) + (round * 7919 + i * 104_729) % (3 * MB));
    let before = resident();
    let say = |what: &str| {
        let found = resident().saturating_sub(before);
        println!("{what}: {:.1} MB", found as f64 / MB as f64);
        found
    };

    // Tables are allocated and dropped, in different sizes each time; one small table of each round stays.
    let (mut kept, mut peak) = (Vec::new(), 0);
    for round in 0..40 {
        let tables: Vec<_> = sizes(round).map(table).collect();
        peak = peak.max(tables.iter().map(Storage::bytes).sum());
        let found = resident().saturating_sub(before);
        assert!(found <= most(peak), "{found} bytes in round {round}, at most {peak} in use");
        kept.push(table(70 << 10));
    }
    println!("most in use at once: {:.1} MB", peak as f64 / MB as f64);
    assert!(say("after 40 rounds, 2.7 MB in use") <= most(kept.len() * (70 << 10)));
    drop(kept);
    assert!(say("after all was dropped") <= 8 * MB);

    // A scene of many tables, of which one small one in each mapping stays.
    let mut scene: Vec<Vec<_>> =
        (0..24).map(|_| (0..40).map(|i| table(if i == 20 { 64 << 10 } else { MB })).collect()).collect();
    assert!(say("a scene of 940 MB") >= 900 * MB);
    for tables in &mut scene {
        let stays = tables.swap_remove(20);
        *tables = vec![stays];
    }
    assert!(say("24 small tables of it") <= most(24 * (64 << 10)));
    assert!(scene.iter().flatten().all(|table| table.as_slice().iter().all(|&byte| byte == 7)));
    // Memory that went back is zero when it is allocated again.
    let again: Vec<_> = (0..200).map(|_| table(MB)).collect();
    assert!(again.iter().all(|table| table.as_slice().iter().all(|&byte| byte == 7)));
    drop(again);
    drop(scene);
    assert!(say("after all was dropped") <= 8 * MB);
}
