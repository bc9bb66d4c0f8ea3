# docker build --tag soslam . && docker run --rm soslam
FROM debian:12-slim
RUN apt-get update && apt-get install --yes --no-install-recommends git make
COPY . /soslam
WORKDIR /soslam
RUN make build
CMD ["make", "demo"]
