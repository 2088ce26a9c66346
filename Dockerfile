# The command line in a container: no screen, no key, no network at run time.
#
#   docker build -t automotive-cosim .
#   docker run --rm -v "$PWD/runs:/work/runs" automotive-cosim run
#
# libsumo's wheel requires the system libraries below (automotive_cosim.traffic.sumo.DEBIAN_PACKAGES); with libfribidi0,
# Pillow sets Arabic and Hebrew names.
FROM python:3.11-slim AS build
COPY . /source
RUN python -m pip install --no-cache-dir build && python -m build --wheel --outdir /dist /source

FROM python:3.11-slim
ARG EXTRAS=doors,models,reports
RUN apt-get update \
    && apt-get install -y --no-install-recommends libgl1 libx11-6 libxext6 libxrender1 libatomic1 libexpat1 libfribidi0 \
    && rm -rf /var/lib/apt/lists/*
COPY constraints.txt /tmp/constraints.txt
COPY --from=build /dist /tmp/dist
RUN wheel="$(ls /tmp/dist/*.whl)" \
    && python -m pip install --no-cache-dir -c /tmp/constraints.txt "${wheel}[${EXTRAS}]" \
    && rm -r /tmp/dist /tmp/constraints.txt \
    && useradd --create-home driver \
    && mkdir -p /work/runs \
    && chown -R driver /work
USER driver
WORKDIR /work
ENTRYPOINT ["automotive-cosim"]
CMD ["run"]
