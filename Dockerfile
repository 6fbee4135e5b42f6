# The program with FEniCSx and meshio, on Debian:
#   docker build -t hypercircle .
#   docker run --rm -v "$PWD:/work" hypercircle verify scene.toml
FROM debian:bookworm AS build
RUN apt-get update \
 && apt-get install -y --no-install-recommends ca-certificates curl gcc libc6-dev \
 && curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y --profile minimal
WORKDIR /source
COPY . .
ARG HYPERCIRCLE_COMMIT
RUN . "$HOME/.cargo/env" && HYPERCIRCLE_COMMIT="$HYPERCIRCLE_COMMIT" cargo build --release --locked

FROM debian:bookworm-slim
RUN apt-get update \
 && apt-get install -y --no-install-recommends python3-dolfinx python3-meshio \
 && rm -rf /var/lib/apt/lists/*
COPY --from=build /source/target/release/hypercircle /usr/local/bin/hypercircle
# MPI of a container has one process, and no reason to look for others.
ENV OMPI_MCA_btl_vader_single_copy_mechanism=none
RUN useradd --create-home user
USER user
WORKDIR /work
ENTRYPOINT ["hypercircle"]
