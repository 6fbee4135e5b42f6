fn main() -> std::process::ExitCode {
    hypercircle::cli::main()
}
