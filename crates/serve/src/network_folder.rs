//! Folders on file systems of another machine, on which the locks of `SQLite` do not work: two
//! programs could write at once and damage the data. The lists contain the common types, so a
//! folder without a warning may still be on another machine.

use std::path::Path;

/// The types of network file systems in the list of mounts, and of folders that a virtual machine
/// shares with its host.
const SHARED: [&str; 21] = [
    "nfs",
    "nfs4",
    "cifs",
    "smb3",
    "smbfs",
    "ncpfs",
    "afs",
    "ceph",
    "lustre",
    "gpfs",
    "glusterfs",
    "beegfs",
    "orangefs",
    "ocfs2",
    "gfs2",
    "davfs",
    "9p",
    "virtiofs",
    "vboxsf",
    "prl_fs",
    "pvfs2",
];
/// The programs that mount a network file system by FUSE.
const SHARED_BY_FUSE: [&str; 13] = [
    "sshfs",
    "rclone",
    "glusterfs",
    "ceph",
    "ceph-fuse",
    "s3fs",
    "davfs",
    "juicefs",
    "gcsfuse",
    "goofys",
    "curlftpfs",
    "grpcfuse",
    "vmhgfs-fuse",
];

/// The type of the file system of another machine that a folder is on, if it is known to be on one.
/// Systems other than Linux have no list of mounts.
pub(crate) fn network_file_system(folder: &Path) -> Option<String> {
    let folder = std::fs::canonicalize(folder).ok()?;
    let mounts = std::fs::read_to_string("/proc/self/mountinfo").ok()?;
    mounted(&mounts, &folder)
}

/// The type of the network file system that a folder is on by a list of mounts.
fn mounted(mounts: &str, folder: &Path) -> Option<String> {
    let mount = |line: &str| {
        let (place, kind) = line.split_once(" - ")?;
        let place = place.split(' ').nth(4)?.replace("\\040", " ");
        let kind = kind.split(' ').next()?;
        folder.starts_with(&place).then(|| (place.len(), kind.to_owned()))
    };
    // Of two mounts at one place, the later one is visible.
    let (_, kind) = mounts.lines().filter_map(mount).max_by_key(|(length, _)| *length)?;
    let is_shared = match kind.strip_prefix("fuse.") {
        Some(program) => SHARED_BY_FUSE.contains(&program),
        None => SHARED.contains(&kind.as_str()),
    };
    is_shared.then_some(kind)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::mounted;

    const MOUNTS: &str = "22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw
41 22 0:40 / /srv/data rw,relatime shared:20 - nfs4 server:/data rw,vers=4.2
42 22 0:41 / /srv/data/local rw - xfs /dev/sdb1 rw
43 22 0:42 / /mnt/my\\040share rw - cifs //server/share rw
44 22 0:43 / /mnt/ssh rw - fuse.sshfs user@host: rw
45 22 0:44 / /mnt/portal rw - fuse.portal portal rw
46 22 0:45 / /mnt/host rw - 9p host rw,trans=virtio
47 22 0:46 / /mnt/virtio rw - virtiofs host rw
48 22 0:47 / /mnt/box rw - vboxsf host rw
49 22 0:48 / /mnt/bucket rw - fuse.gcsfuse bucket rw";

    #[test]
    fn the_innermost_mount_of_a_folder_counts() {
        for (folder, kind) in [
            ("/home/data", None),
            ("/srv/data", Some("nfs4")),
            ("/srv/data/fleet", Some("nfs4")),
            ("/srv/database", None),
            ("/srv/data/local/fleet", None),
            ("/mnt/my share/fleet", Some("cifs")),
            ("/mnt/ssh/fleet", Some("fuse.sshfs")),
            ("/mnt/portal/fleet", None),
            ("/mnt/host/fleet", Some("9p")),
            ("/mnt/virtio/fleet", Some("virtiofs")),
            ("/mnt/box/fleet", Some("vboxsf")),
            ("/mnt/bucket/fleet", Some("fuse.gcsfuse")),
        ] {
            assert_eq!(mounted(MOUNTS, Path::new(folder)).as_deref(), kind, "{folder}");
        }
    }
}
