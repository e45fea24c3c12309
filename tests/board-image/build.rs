//! Finds Unicorn: where `UNICORN_LIB_DIR` says, else where the linker looks by itself.

fn main() {
    println!("cargo:rerun-if-env-changed=UNICORN_LIB_DIR");
    println!("cargo:rerun-if-changed=build.rs");
    if let Some(folder) = std::env::var_os("UNICORN_LIB_DIR") {
        let folder = folder.to_string_lossy();
        println!("cargo:rustc-link-search=native={folder}");
        println!("cargo:rustc-link-arg=-Wl,-rpath,{folder}");
    }
    println!("cargo:rustc-link-lib=dylib=unicorn");
}
