//! The temporary files behind results: what they are called, who removes them, and what becomes of the files that they replace.

use super::{Outcome, names_in};
use radiosity::output::{check_writable, remove_abandoned, write_atomically};
use std::fs::{self, File};
use std::io::Write;

#[test]
fn only_temporary_files_of_our_own_that_nobody_writes_to_are_removed() -> Outcome {
    let folder = tempfile::tempdir()?;
    let at = |name: &str| folder.path().join(name);
    let (left, written) = (
        ".F.csv.radiosity-4000000000-3.part",
        ".F.csv.radiosity-4000000001-3.part",
    );
    let others = [
        ".holiday.2024.7.part",
        ".F.csv.4000000000.3.part",
        ".radiosity-x-1.part",
        "F.csv.radiosity-4000000000-3.part",
        ".F.csv.radiosity-4000000000-3.party",
    ];
    for name in others.into_iter().chain([left]) {
        fs::write(at(name), "")?;
    }
    // As a process of another machine holds it, whose number says nothing here.
    let elsewhere = File::create(at(written))?;
    elsewhere.lock()?;
    remove_abandoned(folder.path());
    let mut kept: Vec<&str> = others.into_iter().chain([written]).collect();
    kept.sort_unstable();
    assert_eq!(names_in(folder.path())?, kept);
    drop(elsewhere);
    remove_abandoned(folder.path());
    kept.retain(|name| *name != written);
    assert_eq!(names_in(folder.path())?, kept);
    Ok(())
}

#[test]
fn a_file_that_is_being_written_is_not_taken_for_abandoned() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("result.txt");
    write_atomically(&path, |out| {
        remove_abandoned(folder.path());
        out.write_all(b"whole")
    })?;
    assert_eq!(fs::read_to_string(&path)?, "whole");
    Ok(())
}

#[test]
fn a_name_as_long_as_the_system_has_them_can_be_written() -> Outcome {
    let folder = tempfile::tempdir()?;
    // Four bytes a character, so that it cannot be cut anywhere.
    for name in [
        format!("{}.csv", "x".repeat(251)),
        format!("a{}.csv", "\u{1F4A1}".repeat(62)),
    ] {
        let path = folder.path().join(&name);
        check_writable(&path)?;
        write_atomically(&path, |out| out.write_all(b"whole"))?;
        assert_eq!(fs::read_to_string(&path)?, "whole");
        fs::remove_file(&path)?;
    }
    assert!(names_in(folder.path())?.is_empty());
    Ok(())
}

#[cfg(unix)]
#[test]
fn a_file_that_takes_the_place_of_another_has_its_permissions() -> Outcome {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("secret.csv");
    for mode in [0o600, 0o664, 0o444] {
        fs::write(&path, "before")?;
        fs::set_permissions(&path, fs::Permissions::from_mode(mode))?;
        write_atomically(&path, |out| {
            let drafts = fs::read_dir(folder.path())?;
            for draft in drafts {
                assert_eq!(draft?.metadata()?.permissions().mode() & 0o777, mode);
            }
            out.write_all(b"after")
        })?;
        assert_eq!(fs::metadata(&path)?.permissions().mode() & 0o777, mode);
        assert_eq!(fs::read_to_string(&path)?, "after");
        fs::remove_file(&path)?;
    }
    Ok(())
}

#[cfg(unix)]
#[test]
fn a_link_to_a_file_that_is_not_there_yet_is_followed() -> Outcome {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir()?;
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("results"))?;
    symlink("results/today.csv", at("latest.csv"))?;
    symlink(at("latest.csv"), at("link.csv"))?;
    check_writable(&at("link.csv"))?;
    write_atomically(&at("link.csv"), |out| out.write_all(b"first"))?;
    assert_eq!(fs::read_to_string(at("results/today.csv"))?, "first");
    for link in ["latest.csv", "link.csv"] {
        assert!(fs::symlink_metadata(at(link))?.is_symlink());
    }

    symlink("round.csv", at("round.csv"))?;
    let error = write_atomically(&at("round.csv"), |out| out.write_all(b"nowhere"));
    let error = error.expect_err("leads nowhere").to_string();
    assert!(error.contains("round.csv: too many links"), "{error}");
    Ok(())
}
