# A class in a container: JupyterLab with the exercises in Python and the notebooks, and the site. teaching/guide/container.md
# describes its use, and that of its first stage, which has Rust, for the exercises in Rust.
#
#     docker build --tag rustslam2d . && docker run --rm --publish 8888:8888 --publish 8080:8080 rustslam2d
FROM debian:trixie-slim AS tools
RUN apt-get update && apt-get install --yes --no-install-recommends \
      build-essential ca-certificates git nodejs npm python3 python3-pip python3-venv rustup \
    && rm -rf /var/lib/apt/lists/*

FROM tools AS packages
WORKDIR /src
COPY . .
# The first call of cargo installs the toolchain that rust-toolchain.toml names.
RUN cargo xtask package

FROM debian:trixie-slim
RUN apt-get update && apt-get install --yes --no-install-recommends ca-certificates python3 python3-pip python3-venv \
    && rm -rf /var/lib/apt/lists/* && useradd --create-home student
COPY --from=packages /src/target/packages/*.whl /tmp/wheels/
RUN python3 -m venv /opt/venv \
    && /opt/venv/bin/pip install --no-cache-dir jupyterlab matplotlib pytest /tmp/wheels/*.whl && rm -r /tmp/wheels
ENV PATH=/opt/venv/bin:$PATH
COPY --from=packages /src/dist /opt/site
COPY teaching/container/start.sh /opt/start.sh
COPY --chown=student teaching/exercises/python /course/exercises
COPY --chown=student crates/robots/slam2d_py/notebooks /course/notebooks
RUN rm -r /course/exercises/solutions /course/exercises/mutants.py && mkdir /course/work \
    && chown student /course /course/work
USER student
WORKDIR /course
EXPOSE 8080 8888
CMD ["sh", "/opt/start.sh"]
