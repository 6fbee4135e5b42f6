#[global_allocator]
static ALLOCATOR: hypercircle::budget::ExitOnExhaustion = hypercircle::budget::ExitOnExhaustion;

fn main() -> std::process::ExitCode {
    hypercircle::cli::main()
}
