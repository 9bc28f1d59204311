//! What travels with an FMU: the files and the manifest that names them.

use crate::{FOLDER, MANIFEST, Manifest, Related};

/// Files for the layered standard's folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Files {
    manifest: Manifest,
    contents: Vec<(String, Vec<u8>)>,
}

impl Files {
    /// Adds a file beside the manifest, which names it.
    pub fn add(&mut self, file: Related, contents: Vec<u8>) {
        self.attach(&file.source, contents);
        self.name(file);
    }

    /// Adds a file that another file in the folder names, as experiments do their tables.
    pub fn attach(&mut self, source: &str, contents: Vec<u8>) {
        self.contents.push((source.into(), contents));
    }

    /// Names a file that is elsewhere in the archive.
    pub fn name(&mut self, file: Related) {
        self.manifest.related.push(file);
    }

    /// Paths in the archive and contents, the manifest first.
    pub fn archived(&self) -> impl Iterator<Item = (String, Vec<u8>)> {
        let manifest = (format!("{FOLDER}/{MANIFEST}"), self.manifest.document());
        let files =
            self.contents.iter().map(|(name, contents)| (format!("{FOLDER}/{name}"), contents.clone()));
        std::iter::once(manifest).chain(files)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manifest_names_what_it_is_told_to() {
        let mut files = Files::default();
        files.add(Related::new("text/plain", "a.txt", "other", "a"), b"a".to_vec());
        files.attach("b.csv", b"b".to_vec());
        files.name(Related::new("text/html", "../../documentation/index.html", "document", "c"));
        let archived: Vec<(String, Vec<u8>)> = files.archived().collect();
        let names: Vec<&str> =
            archived.iter().filter_map(|(name, _)| Some(name.rsplit_once('/')?.1)).collect();
        assert_eq!(names, [MANIFEST, "a.txt", "b.csv"]);
        let text = String::from_utf8(archived[0].1.clone()).unwrap();
        assert!(text.contains("a.txt") && !text.contains("b.csv") && text.contains("index.html"));
    }
}
