//! Memory that the system still has to give, as Linux tells it.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// Bytes that this process can still take: what the machine has free or can free, what its control groups leave, and
/// what its limits of address space and data leave beside the workspaces of `threads` threads, whichever is least.
/// `None` where the system tells nothing.
pub fn available(threads: usize) -> Option<u64> {
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let machine = kilobytes(&read("/proc/meminfo"), "MemAvailable:");
    let limits = address_space(&read("/proc/self/limits"), &read("/proc/self/status"))
        .map(|left| left.saturating_sub(workspace().saturating_mul(threads as u64)));
    let groups = control_groups(&read("/proc/self/cgroup"), Path::new("/sys/fs/cgroup"));
    [machine, limits, groups].into_iter().flatten().min()
}

/// Bytes of memory that this process holds; 0 where the system does not tell.
pub fn resident() -> u64 {
    fs::read_to_string("/proc/self/status").ok().and_then(|text| kilobytes(&text, "VmRSS:")).unwrap_or(0)
}

/// The line `KEY NUMBER kB` of a file of /proc, in bytes.
fn kilobytes(text: &str, key: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(key))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kilobytes| kilobytes.saturating_mul(1024))
}

/// Bytes that `ulimit -v` and `ulimit -d` leave.
fn address_space(limits: &str, status: &str) -> Option<u64> {
    let left = |limit: &str, used: &str| {
        let line = limits.lines().find_map(|line| line.strip_prefix(limit))?;
        // "unlimited" is no number.
        let most: u64 = line.split_whitespace().next()?.parse().ok()?;
        Some(most.saturating_sub(kilobytes(status, used).unwrap_or(0)))
    };
    [left("Max address space", "VmSize:"), left("Max data size", "VmData:")].into_iter().flatten().min()
}

/// Address space that products of matrices take on each thread: room for two parts as large as the last cache. Hardly any
/// of it is touched, so that it counts nowhere else.
fn workspace() -> u64 {
    let size = fs::read_to_string("/sys/devices/system/cpu/cpu0/cache/index3/size").unwrap_or_default();
    let kilobytes: u64 = size.trim().strip_suffix('K').and_then(|size| size.parse().ok()).unwrap_or(32 * 1024);
    2 * 1024 * kilobytes
}

/// Bytes that the control groups of this process leave, those above its own too: version 2, and the memory controller of
/// version 1.
fn control_groups(own: &str, root: &Path) -> Option<u64> {
    let mut least = None;
    for line in own.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let (base, most, used, cache) = match controllers {
            "" => (root.to_path_buf(), "memory.max", "memory.current", "inactive_file "),
            c if c.split(',').any(|c| c == "memory") => {
                (root.join("memory"), "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file ")
            }
            _ => continue,
        };
        let mut folders = vec![base.clone()];
        let mut folder: PathBuf = base;
        for part in Path::new(path).components() {
            if let Component::Normal(part) = part {
                folder.push(part);
                folders.push(folder.clone());
            }
        }
        let number = |file: PathBuf| fs::read_to_string(file).ok()?.trim().parse::<u64>().ok();
        for folder in folders {
            let (Some(most), Some(used)) = (number(folder.join(most)), number(folder.join(used))) else { continue };
            // Files that were read and not changed count as used, and are given up when memory is asked for.
            let stat = fs::read_to_string(folder.join("memory.stat")).unwrap_or_default();
            let cached = stat.lines().find_map(|line| line.strip_prefix(cache)?.trim().parse::<u64>().ok());
            let left = most.saturating_sub(used.saturating_sub(cached.unwrap_or(0)));
            least = Some(least.map_or(left, |l: u64| l.min(left)));
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_machine_s_memory_is_read() {
        let text = "MemTotal:       24637028 kB\nMemFree:         100 kB\nMemAvailable:   15728640 kB\n";
        assert_eq!(kilobytes(text, "MemAvailable:"), Some(15_728_640 * 1024));
        assert_eq!(kilobytes(text, "MemMissing:"), None);
    }

    #[test]
    fn limits_leave_what_is_not_used() {
        let limits = "Limit                     Soft Limit           Hard Limit           Units     \n\
                      Max data size             unlimited            unlimited            bytes     \n\
                      Max address space         204800000            unlimited            bytes     \n";
        let status = "VmSize:\t  100000 kB\nVmData:\t 50000 kB\n";
        assert_eq!(address_space(limits, status), Some(204_800_000 - 102_400_000));
        assert_eq!(address_space(&limits.replace("204800000", "unlimited"), status), None);
        assert_eq!(address_space(limits, "VmSize:\t  300000 kB\n"), Some(0), "nothing is left");
    }

    #[test]
    fn the_least_of_nested_control_groups_counts() {
        let root = tempfile::tempdir().expect("a folder");
        let folder = |path: &str, most: &str, used: &str, stat: &str| {
            let folder = root.path().join(path);
            std::fs::create_dir_all(&folder).expect("a folder");
            let [m, u] = if path.starts_with("memory") {
                ["memory.limit_in_bytes", "memory.usage_in_bytes"]
            } else {
                ["memory.max", "memory.current"]
            };
            std::fs::write(folder.join(m), most).expect("written");
            std::fs::write(folder.join(u), used).expect("written");
            std::fs::write(folder.join("memory.stat"), stat).expect("written");
        };
        folder("outer", "1000\n", "700\n", "file 600\ninactive_file 100\n");
        folder("outer/inner", "max\n", "50\n", "");
        assert_eq!(control_groups("0::/outer/inner\n", root.path()), Some(400));
        folder("outer/inner", "300\n", "50\n", "");
        assert_eq!(control_groups("0::/outer/inner\n", root.path()), Some(250));
        folder("memory/job", "120\n", "100\n", "inactive_file 1\ntotal_inactive_file 10\n");
        let both = "5:cpu,cpuacct:/\n4:memory:/job\n0::/outer/inner\n";
        assert_eq!(control_groups(both, root.path()), Some(30));
        assert_eq!(control_groups("0::/elsewhere\n", root.path()), None);
    }

    #[test]
    fn this_process_holds_something() {
        if cfg!(target_os = "linux") {
            assert!(resident() > 1_000_000);
            assert!(available(1).is_some_and(|bytes| bytes > 1_000_000));
        }
    }
}
